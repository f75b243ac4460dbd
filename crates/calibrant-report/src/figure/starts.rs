//! The figure of the final values of all starts of the search.

use super::Figure;
use super::panel::Panel;
use crate::design::starts::{groups, name};
use calibrant_core::information::Criterion;
use calibrant_design::{DesignStatus, StartOutcome};

/// The values of all starts, best first, as their distance from the best. `None` where there is nothing to
/// compare.
pub(crate) fn start_values(starts: &[StartOutcome], criterion: &Criterion) -> Option<Figure> {
    let groups = groups(starts, criterion);
    if groups.iter().all(|group| group.sorted.len() < 2) {
        return None;
    }
    let nats = matches!(criterion, Criterion::D(_));
    let panels: Vec<Panel> = groups
        .iter()
        .map(|group| {
            let excess: Vec<f64> = group.sorted.iter().map(|start| group.excess(start)).collect();
            let largest = excess.iter().copied().filter(|e| e.is_finite()).fold(0.0, f64::max);
            let (factor, label) = match largest {
                _ if nats => (1.0, "above the best (nats)"),
                most if most < 1e-4 => (1e6, "above the best (ppm)"),
                _ => (100.0, "above the best (%)"),
            };
            let ranked = (1..)
                .map(f64::from)
                .zip(&group.sorted)
                .zip(&excess)
                .map(|((rank, start), e)| (start.status == DesignStatus::Converged, (rank, e * factor)));
            Panel::new(name(&group.axes), "rank of the start", label)
                .with_used(["converged", "not converged"], [3.4, 3.4], ranked)
                .log_or_from_zero(false)
        })
        .collect();
    let caption = "One marker for each start of the search, best first. Many at zero: many starts found the best motion, so a better one is \
                   unlikely. Steps: the problem has several local optima. Mirrored motions are the same optimum. Only one \
                   at zero: use more starts.";
    Some(Figure::new("Values of the starts, sorted", panels, caption))
}
