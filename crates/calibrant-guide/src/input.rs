//! Where the samples come from: a serial port, the network, standard input, or a recording that is played again.

use crate::arrival::Arrival;
use crate::demo;
use crate::replay;
use calibrant::session::Session;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use std::io::Read;
use std::net::{TcpStream, UdpSocket};
use std::path::PathBuf;
use std::sync::mpsc::SyncSender;
use std::thread;
use std::time::{Duration, Instant};

/// A source of samples.
///
/// # Examples
/// ```
/// use calibrant_guide::Input;
/// assert!(matches!(Input::parse("serial:/dev/ttyUSB0:115200"), Ok(Input::Serial { baud: 115_200, .. })));
/// assert!(Input::parse("serial:/dev/ttyUSB0").is_ok(), "115200 is usual");
/// assert!(Input::parse("usb:1").is_err());
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum Input {
    /// A serial port: its path or name, and its rate in baud.
    Serial {
        /// `/dev/ttyUSB0`, `COM3`.
        port: String,
        /// Rate in baud.
        baud: u32,
    },
    /// Datagrams to this address, each with one or more lines.
    Udp(String),
    /// A server that sends lines.
    Tcp(String),
    /// Standard input.
    Stdin,
    /// A recording that is played again, so many times as fast.
    Replay {
        /// The recording, a text.
        path: PathBuf,
        /// 1: in real time.
        speed: f64,
    },
    /// A simulated board in a simulated hand, which follows the advice.
    Demo {
        /// 1: as fast as a person.
        speed: f64,
    },
}

/// Usual rate of boards, baud.
const USUAL_BAUD: u32 = 115_200;
/// A server that says nothing for so long is asked again.
const SILENT: Duration = Duration::from_secs(5);
/// How long a read waits, and how long until a lost input is tried again.
const WAIT: Duration = Duration::from_millis(100);
const AGAIN: Duration = Duration::from_millis(500);

impl Input {
    /// From text: `serial:PORT:BAUD`, `udp:HOST:PORT`, `tcp:HOST:PORT`, `-`, `replay:FILE@SPEED`.
    ///
    /// # Errors
    /// [`Error::Experiment`] with the forms that are known.
    pub fn parse(text: &str) -> Result<Self> {
        let refused = |message: String| {
            let help = "give serial:/dev/ttyUSB0:115200, udp:0.0.0.0:5555, tcp:host:5555, replay:recording.csv@4, demo, or - for standard input";
            Error::experiment(InputError::new(Refusal::ValueInvalid, message, help))
        };
        if text == "-" {
            return Ok(Self::Stdin);
        }
        let with_speed = |of: &str, usual: f64| match of.rsplit_once('@') {
            Some((of, speed)) => {
                let number = speed.parse().ok().filter(|speed: &f64| (1e-3..=1e3).contains(speed));
                Ok((of.to_owned(), number.ok_or_else(|| refused(format!("\"{speed}\" is no speed")))?))
            }
            None => Ok((of.to_owned(), usual)),
        };
        if text == "demo" || text.starts_with("demo@") {
            return Ok(Self::Demo { speed: with_speed(text, 3.0)?.1 });
        }
        let (kind, of) = text
            .split_once(':')
            .ok_or_else(|| refused(format!("no source of samples is called \"{text}\"")))?;
        match kind {
            "serial" => {
                let with_baud = of.rsplit_once(':').and_then(|(port, baud)| Some((port, baud.parse().ok()?)));
                let (port, baud) = with_baud.unwrap_or((of, USUAL_BAUD));
                if port.is_empty()
                    || baud == 0
                    || (with_baud.is_none() && port.starts_with('/') && port.contains(':'))
                {
                    return Err(refused(format!("\"{of}\" is no serial port and rate in baud")));
                }
                Ok(Self::Serial { port: port.to_owned(), baud })
            }
            "udp" | "tcp" => {
                let port = of.rsplit_once(':').and_then(|(_, port)| port.parse::<u16>().ok());
                port.ok_or_else(|| refused(format!("\"{of}\" is no address with a port")))?;
                Ok(if kind == "udp" { Self::Udp(of.to_owned()) } else { Self::Tcp(of.to_owned()) })
            }
            "replay" => {
                let (path, speed) = with_speed(of, 1.0)?;
                Ok(Self::Replay { path: path.into(), speed })
            }
            _ => Err(refused(format!("no source of samples is called \"{kind}\""))),
        }
    }

    /// Begins to read. What comes goes to `to`, until that is closed.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the input is not there.
    pub(crate) fn open(
        &self,
        session: &Session,
        to: SyncSender<Arrival>,
        advice: &demo::Advice,
    ) -> Result<()> {
        let begin = Instant::now();
        match self {
            Self::Serial { port, baud } => {
                let (port, baud) = (port.clone(), *baud);
                let first =
                    serial(&port, baud).map_err(|error| absent(&format!("serial port {port}"), &error))?;
                thread::spawn(move || again_and_again(first, || serial(&port, baud), &to, begin));
            }
            Self::Udp(address) => {
                let socket = UdpSocket::bind(address.as_str())
                    .map_err(|error| absent(&format!("udp {address}"), &error))?;
                thread::spawn(move || {
                    let mut buffer = vec![0; 65_536];
                    while let Ok(count) = socket.recv(&mut buffer) {
                        let mut bytes = buffer[..count].to_vec();
                        if bytes.last() != Some(&b'\n') {
                            bytes.push(b'\n');
                        }
                        if to.send(Arrival::Bytes { bytes, at_s: begin.elapsed().as_secs_f64() }).is_err() {
                            return;
                        }
                    }
                });
            }
            Self::Tcp(address) => {
                let to_server = address.clone();
                let connect = move || {
                    let stream = TcpStream::connect(to_server.as_str())?;
                    // a board that is switched off says nothing
                    stream.set_read_timeout(Some(SILENT))?;
                    Ok(stream)
                };
                let first = connect().map_err(|error| absent(&format!("tcp {address}"), &error))?;
                thread::spawn(move || again_and_again(first, connect, &to, begin));
            }
            Self::Stdin => {
                thread::spawn(move || {
                    let _ = pump(&mut std::io::stdin().lock(), &to, begin);
                    let _ = to.send(Arrival::End);
                });
            }
            Self::Replay { path, speed } => replay::start(session, path, *speed, to)?,
            Self::Demo { speed } => demo::start(to, advice.clone(), *speed),
        }
        Ok(())
    }
}

fn absent(what: &str, error: &std::io::Error) -> Error {
    let help = match error.kind() {
        std::io::ErrorKind::PermissionDenied => {
            "may you read it? On Linux the group `dialout` may: sudo usermod -aG dialout $USER, then log in again"
        }
        _ if what.starts_with("tcp") => "does the server run, and do address and port hold?",
        std::io::ErrorKind::AddrNotAvailable => "give an address of this machine, or 0.0.0.0 for all of them",
        std::io::ErrorKind::AddrInUse => "another program listens there: end it, or take another port",
        _ => "is the board plugged in, and the name right? `ls /dev/tty*` or the device manager shows it",
    };
    Error::experiment(InputError::new(
        Refusal::FileUnreadable,
        format!("{what} cannot be opened: {error}"),
        help,
    ))
}

fn serial(port: &str, baud: u32) -> std::io::Result<serial2::SerialPort> {
    let mut open = serial2::SerialPort::open(port, baud)?;
    open.set_read_timeout(WAIT)?;
    Ok(open)
}

/// Reads until the end or an error.
fn pump(from: &mut impl Read, to: &SyncSender<Arrival>, begin: Instant) -> std::io::Result<()> {
    let mut buffer = vec![0; 16_384];
    loop {
        match from.read(&mut buffer) {
            Ok(0) => return Ok(()),
            Ok(count) => {
                let bytes = buffer[..count].to_vec();
                let sent = to.send(Arrival::Bytes { bytes, at_s: begin.elapsed().as_secs_f64() });
                sent.map_err(|_| std::io::Error::other("nobody listens"))?;
            }
            Err(error)
                if matches!(error.kind(), std::io::ErrorKind::TimedOut | std::io::ErrorKind::Interrupted) => {
            }
            Err(error) => return Err(error),
        }
    }
}

/// Reads from what `open` opens, and opens it again when it is gone.
fn again_and_again<T: Read>(
    first: T,
    open: impl Fn() -> std::io::Result<T>,
    to: &SyncSender<Arrival>,
    begin: Instant,
) {
    let mut input = first;
    loop {
        let why = match pump(&mut input, to, begin) {
            Ok(()) => "it was closed".to_owned(),
            Err(error) => error.to_string(),
        };
        if to.send(Arrival::Lost(why)).is_err() {
            return;
        }
        input = loop {
            thread::sleep(AGAIN);
            match open() {
                Ok(input) => break input,
                // is anybody there?
                Err(_)
                    if to
                        .send(Arrival::Bytes { bytes: Vec::new(), at_s: begin.elapsed().as_secs_f64() })
                        .is_err() =>
                {
                    return;
                }
                Err(_) => {}
            }
        };
        if to.send(Arrival::Back).is_err() {
            return;
        }
    }
}
