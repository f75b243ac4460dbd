//! A sum of derivatives of readings, and its own derivatives: what a change of the motion does to what nuisances do.
//!
//! # Formula
//! Frame `k` is turned by `φ_r` and shifted by `σ_r`, vectors that it carries, another pair for each row `r` of the readings. The specific force of the sensor changes by
//! `ḧ + a×φ` with `h = φ×r` (see [`super::sweep`]), or by `σ̈`. The sum over the rows, each in its axis `e_r` of the sensor, needs the matrices `Φ = Σ φ_r e_rᵀ` and
//! `Σ = Σ σ_r e_rᵀ` of the rows of the specific force, and `Ψ` of those of the rate, alone. With `ax(Σ x yᵀ) = Σ x×y`, and `a`, `ω`, `ω̇` of frame `k`:
//!
//! ```text
//! L = a·ax Φ + tr Φ (ω̇·r + 2ω·ṙ) − r·Φω̇ − 2ṙ·Φω + ω·Φ(ω×r) + ω² r·ax Φ      of turns
//!   + ω̇·ax Σ + ω·Σω − ω² tr Σ + ω·ax Ψ                                        of shifts, and of the rate
//! ```
//!
//! Its bars of `a`, `ω` and `ω̇` go with the reverse sweep to the joints before frame `k`: these turn it as a whole. A joint behind it moves the sensor, with the bars of `r`
//! and `ṙ`, and turns the rows, with `ν = Σ e_r × ∂L/∂e_r`.
//!
//! A shift in time `τ_r` counts as the reading's derivative in time. Its derivatives by a joint are those of the reading, differentiated.

use super::links::Links;
use super::sweep::{JointAt, JointBars, Moving, ReadingSlopes, Sweep};
use super::vector::{M, V};

/// A direction for each row of the readings, in all that may change.
#[derive(Debug, Clone)]
pub(crate) struct Contraction {
    /// Turn of each frame for each row, in the frame's axes.
    pub(crate) turns: Vec<[V; 6]>,
    /// Shift of each frame for each row of the specific force, in the frame's axes.
    pub(crate) shifts: Vec<[V; 3]>,
    /// Change of the specific force of the base for each row of the specific force.
    pub(crate) base: [V; 3],
    /// Shift in time for each row, s.
    pub(crate) times_s: [f64; 6],
    /// Bars of each frame.
    bars: Vec<Moving>,
}

/// Bars of what is between a frame and the sensor: of `r`, of `ṙ`, and of the sensor's axes.
#[derive(Debug, Clone, Copy)]
struct Between {
    r: V,
    rd: V,
    axes: V,
}

impl Contraction {
    /// For a chain of this many joints.
    pub(crate) fn new(joints: usize) -> Self {
        Self {
            turns: vec![[V::ZERO; 6]; joints + 1],
            shifts: vec![[V::ZERO; 3]; joints + 1],
            base: [V::ZERO; 3],
            times_s: [0.0; 6],
            bars: vec![Moving::ZERO; joints + 1],
        }
    }

    /// No direction.
    pub(crate) fn clear(&mut self) {
        self.turns.fill([V::ZERO; 6]);
        self.shifts.fill([V::ZERO; 3]);
        self.base = [V::ZERO; 3];
        self.times_s = [0.0; 6];
    }

    /// Adds the derivatives of the sum, and of what the readings have as bars, by the joints: `bars`, and those by jerks.
    pub(crate) fn differentiate(
        &mut self,
        sweep: &Sweep,
        links: &Links,
        joints: &[JointAt],
        readings: &[V; 2],
        (bars, of_jerks): (&mut [JointBars], &mut [f64]),
    ) {
        let sensor = sweep.sensor();
        let axes = &sensor.turn;
        let mut between = Between {
            r: V::ZERO,
            rd: V::ZERO,
            axes: M::of_columns(self.base).product_transposed(axes).axial() * -1.0,
        };
        let [a, b, c, d, e, f] = self.times_s;
        let (t, s) = (axes.times(&V([a, b, c])), axes.times(&V([d, e, f])));
        for k in 0..self.turns.len() {
            let (own, behind) = self.frame(sweep, k);
            self.bars[k] = own;
            between = Between {
                r: between.r + behind.r,
                rd: between.rd + behind.rd,
                axes: between.axes + behind.axes,
            };
            let (Some(bars), Some(of_jerk), Some(joint)) =
                (bars.get_mut(k), of_jerks.get_mut(k), links.joints.get(k))
            else {
                continue;
            };
            let [z, zd, _] = &sweep.frames[k].z;
            let [r, rd, _] = sweep.to_sensor(k);
            let (once, twice) =
                if joint.turns { (z.cross(&r), zd.cross(&r) + z.cross(&rd)) } else { (*z, *zd) };
            bars.q += once.dot(&between.r) + twice.dot(&between.rd);
            bars.qd += once.dot(&between.rd);
            if joint.turns {
                bars.q += z.dot(&between.axes);
            }
            let slopes = sweep.of_joint(links, k);
            let by_state = |[q, qd, qdd, rate_q, rate_qd]: &ReadingSlopes, t: &V, s: &V| {
                [t.dot(q) + s.dot(rate_q), t.dot(qd) + s.dot(rate_qd), t.dot(qdd)]
            };
            let own = by_state(&slopes, &t, &s);
            let changed = by_state(&change(sweep, k, joint.turns), &t, &s);
            let w = &sensor.moving.w;
            let turned = by_state(&slopes, &w.cross(&t), &w.cross(&s));
            bars.q += changed[0] + turned[0];
            bars.qd += changed[1] + turned[1] + own[0];
            bars.qdd += changed[2] + turned[2] + own[1];
            *of_jerk += own[2];
        }
        sweep.reverse(links, joints, readings, |k| self.bars[k], bars);
    }

    /// The bars of frame `k`, and those between it and the sensor.
    #[inline(always)]
    fn frame(&self, sweep: &Sweep, k: usize) -> (Moving, Between) {
        let (frame, axes) = (&sweep.frames[k], &sweep.sensor().turn);
        let [r, rd, _] = sweep.to_sensor(k);
        let Moving { a, w, wd } = &frame.moving;
        let [x, y, z, rx, ry, rz] = self.turns[k];
        let in_base = |rows: [V; 3]| frame.turn.product(&M::of_columns(rows)).product_transposed(axes);
        let (turn, of_rate, shift) = (in_base([x, y, z]), in_base([rx, ry, rz]), in_base(self.shifts[k]));
        let (trace, ax) = (turn.trace(), turn.axial());
        let (shift_trace, shift_ax) = (shift.trace(), shift.axial());
        let (wr, square) = (w.cross(&r), w.dot(w));
        let turned_w = turn.transposed_times(w);
        let of_rd = (*w * trace - turn.times(w)) * 2.0;
        let own = Moving {
            a: ax,
            w: (rd * trace - turn.transposed_times(&rd)) * 2.0
                + turn.times(&wr)
                + r.cross(&turned_w)
                + *w * (2.0 * (r.dot(&ax) - shift_trace))
                + of_rate.axial()
                + shift.times(w)
                + shift.transposed_times(w)
                + r.cross(&of_rd),
            wd: r * trace - turn.transposed_times(&r) + shift_ax,
        };
        let of_axes = turn.times(a) - *a * trace + ax * (wd.dot(&r) + 2.0 * w.dot(&rd))
            - wd.cross(&turn.transposed_times(&r))
            - w.cross(&turn.transposed_times(&rd)) * 2.0
            + wr.cross(&turned_w)
            + (turn.times(&r) - r * trace) * square
            + shift.times(wd)
            - *wd * shift_trace
            + w.cross(&shift.transposed_times(w))
            - shift_ax * square
            + of_rate.times(w)
            - *w * of_rate.trace();
        let of_r = *wd * trace - turn.times(wd) + turned_w.cross(w) + ax * square;
        (own, Between { r: of_r, rd: of_rd, axes: -of_axes })
    }
}

/// The derivatives in time of the readings' derivatives by joint `k`.
fn change(sweep: &Sweep, k: usize, turns: bool) -> ReadingSlopes {
    let (frame, sensor) = (&sweep.frames[k], sweep.sensor());
    let [z, zd, zdd] = &frame.z;
    let Moving { w, wd, .. } = &frame.moving;
    let [ad, wdd] = &frame.third;
    let zddd = wdd.cross(z) + wd.cross(zd) * 2.0 + w.cross(zdd);
    if !turns {
        return [zddd, *zdd * 2.0, *zd, V::ZERO, V::ZERO];
    }
    let [r, rd, rdd] = sweep.to_sensor(k);
    let rddd = sensor.third[0] - *ad;
    let once = zd.cross(&r) + z.cross(&rd);
    let twice = zdd.cross(&r) + zd.cross(&rd) * 2.0 + z.cross(&rdd);
    let thrice = zddd.cross(&r) + (zdd.cross(&rd) + zd.cross(&rdd)) * 3.0 + z.cross(&rddd);
    let of_axes = sensor.third[0].cross(z) + sensor.moving.a.cross(zd);
    [thrice + of_axes, twice * 2.0, once, *zdd, *zd]
}
