//! The page on loopback: server-sent events one way, three actions the other.
//!
//! Other sites' pages can reach loopback: an action needs the token of the page's address, and a request must name this host.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use std::io::Write;
use std::net::SocketAddr;
use std::sync::mpsc::Sender;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::Duration;
use tiny_http::{Header, Method, Request, Response, Server};

/// What a person asks for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Action {
    Undo,
    Note(String),
    Finish,
}

const PAGE: &str = include_str!("page.html");
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; connect-src 'self'; img-src data:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";
/// Longest note, bytes.
const LONGEST_NOTE: usize = 2000;
/// After so long without an event the last one goes out again: a page that left is noticed, and one that is there knows that the guide is.
const QUIET: Duration = Duration::from_secs(1);

/// What the pages show.
#[derive(Debug, Default)]
struct Shown {
    live: (u64, String),
    result: (u64, String),
    closed: bool,
}

/// What the pages show, for all of them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Board(Arc<(Mutex<Shown>, Condvar)>);

impl Board {
    fn change(&self, change: impl FnOnce(&mut Shown)) {
        let (shown, changed) = &*self.0;
        change(&mut shown.lock().unwrap_or_else(PoisonError::into_inner));
        changed.notify_all();
    }

    pub(crate) fn live(&self, json: String) {
        self.change(|shown| shown.live = (shown.live.0 + 1, json));
    }

    pub(crate) fn result(&self, json: String) {
        self.change(|shown| shown.result = (shown.result.0 + 1, json));
    }

    pub(crate) fn close(&self) {
        self.change(|shown| shown.closed = true);
    }

    /// What changed since these versions; `None` when all is over.
    fn next(&self, seen: &mut (u64, u64)) -> Option<String> {
        let (shown, changed) = &*self.0;
        let shown = shown.lock().unwrap_or_else(PoisonError::into_inner);
        let is_old = |of: &mut Shown| (of.live.0, of.result.0) == *seen && !of.closed;
        let (shown, _) =
            changed.wait_timeout_while(shown, QUIET, is_old).unwrap_or_else(PoisonError::into_inner);
        let mut text = String::new();
        if shown.result.0 != seen.1 {
            text.push_str(&format!("event: result\ndata: {}\n\n", shown.result.1));
        }
        if shown.live.0 != seen.0 {
            text.push_str(&format!("event: live\ndata: {}\n\n", shown.live.1));
        }
        if text.is_empty() {
            if shown.closed {
                return None;
            }
            text.push_str(&match shown.live.1.as_str() {
                "" => ": still here\n\n".to_owned(),
                live => format!("event: live\ndata: {live}\n\n"),
            });
        }
        *seen = (shown.live.0, shown.result.0);
        Some(text)
    }
}

/// Serves the page. Gives its address, with the token.
///
/// # Errors
/// [`Error::Experiment`] where the address is taken.
pub(crate) fn serve(address: &str, token: String, board: Board, actions: Sender<Action>) -> Result<String> {
    let server = Server::http(address).map_err(|error| {
        let help = "another program, or another guide, listens there: give another address by option `listen`, such as 127.0.0.1:8766";
        Error::experiment(InputError::new(Refusal::ValueInvalid, format!("{address} cannot be listened on: {error}"), help))
    })?;
    let at = server.server_addr().to_ip();
    let url = match at {
        Some(at) if at.ip().is_unspecified() => format!(
            "http://127.0.0.1:{port}/?token={token} (from another device: the address of this machine in place of 127.0.0.1)",
            port = at.port()
        ),
        Some(at) => format!("http://{at}/?token={token}"),
        None => format!("http://{address}/?token={token}"),
    };
    let guard = Guard { at, token };
    thread::spawn(move || {
        for request in server.incoming_requests() {
            guard.answer(request, &board, &actions);
        }
    });
    Ok(url)
}

struct Guard {
    at: Option<SocketAddr>,
    token: String,
}

impl Guard {
    fn answer(&self, mut request: Request, board: &Board, actions: &Sender<Action>) {
        // a body that is not read would be read when the request is dropped, however long it says it is
        if request.body_length().is_some_and(|length| length > LONGEST_NOTE)
            || header(&request, "Transfer-Encoding").is_some()
        {
            std::mem::forget(request);
            return;
        }
        let path = request.url().split('?').next().unwrap_or("/").to_owned();
        if !self.is_own_host(&request) {
            return reply(request, 403, "this address is not that of the guide");
        }
        match (request.method(), path.as_str()) {
            (Method::Get, "/") => {
                let mut response = Response::from_string(PAGE);
                for (name, value) in [
                    ("Content-Type", "text/html; charset=utf-8"),
                    ("Content-Security-Policy", POLICY),
                    ("Cache-Control", "no-store"),
                    ("Referrer-Policy", "no-referrer"),
                ] {
                    if let Ok(header) = Header::from_bytes(name, value) {
                        response.add_header(header);
                    }
                }
                let _ = request.respond(response);
            }
            (Method::Get, "/events") => {
                let board = board.clone();
                thread::spawn(move || stream(request, &board));
            }
            (Method::Post, "/undo" | "/note" | "/finish") => {
                let given = header(&request, "X-Token");
                if given.as_deref() != Some(self.token.as_str()) {
                    return reply(
                        request,
                        403,
                        "open the page by the address that the guide printed: it has a token",
                    );
                }
                let mut text = String::new();
                let read = std::io::Read::read_to_string(
                    &mut std::io::Read::take(request.as_reader(), LONGEST_NOTE as u64),
                    &mut text,
                );
                let action = match path.as_str() {
                    "/undo" => Action::Undo,
                    "/finish" => Action::Finish,
                    _ if read.is_err() || text.trim().is_empty() => {
                        return reply(request, 400, "a note needs a text");
                    }
                    _ => Action::Note(text.trim().to_owned()),
                };
                let taken = actions.send(action).is_ok();
                reply(
                    request,
                    if taken { 200 } else { 410 },
                    if taken { "done" } else { "the guide has ended" },
                );
            }
            (Method::Get, "/favicon.ico") => reply(request, 404, ""),
            _ => reply(request, 404, "there is the page / and its /events"),
        }
    }

    /// Is the request for this host, and from its own page?
    fn is_own_host(&self, request: &Request) -> bool {
        let host = header(request, "Host").unwrap_or_default();
        let name = host.rsplit_once(':').map_or(host.as_str(), |(name, _)| name);
        let is_loopback = matches!(name, "127.0.0.1" | "localhost" | "[::1]");
        // where it is opened to others, a name of the machine leads here
        let is_open = self.at.is_some_and(|at| !at.ip().is_loopback());
        let origin = header(request, "Origin");
        let same = origin.is_none_or(|origin| origin.split_once("://").is_some_and(|(_, of)| of == host));
        same && (is_loopback || is_open)
    }
}

fn header(request: &Request, name: &str) -> Option<String> {
    let found =
        request.headers().iter().find(|header| header.field.as_str().as_str().eq_ignore_ascii_case(name));
    found.map(|header| header.value.as_str().to_owned())
}

fn reply(request: Request, status: u16, text: &str) {
    let _ = request.respond(Response::from_string(text).with_status_code(status));
}

/// Sends events until the page is gone.
fn stream(request: Request, board: &Board) {
    let mut to = request.into_writer();
    let head = "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\nretry: 1000\n\n";
    let mut seen = (0, 0);
    let mut text = head.to_owned();
    loop {
        if to.write_all(text.as_bytes()).and_then(|()| to.flush()).is_err() {
            return;
        }
        match board.next(&mut seen) {
            Some(more) => text = more,
            None => return,
        }
    }
}
