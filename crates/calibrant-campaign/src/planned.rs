//! A designed campaign with all that its file and its page show.

use crate::{Campaign, CampaignDesign, Channel, TimedSoak, UsualCampaign, design_over_cycles};
use calibrant_core::error::Result;
use std::ops::RangeInclusive;

/// A campaign, and what is usual in its time.
#[derive(Debug, Clone, Copy)]
pub struct PlannedCampaign<'a> {
    /// Chamber, time and channels.
    pub campaign: &'a Campaign,
    /// The best campaign.
    pub design: &'a CampaignDesign,
    /// Its soaks in their time.
    pub timetable: &'a [TimedSoak],
    /// The usual campaigns in the same time.
    pub usual: &'a [UsualCampaign],
    /// The least time in which the relaxed campaign meets the goals on average, min, where this one does not; `None` as of
    /// [`time_needed_min`](crate::time_needed_min).
    pub time_needed_min: Option<f64>,
}

/// The best campaigns over their time.
#[derive(Debug, Clone, PartialEq)]
pub struct CampaignSweep {
    /// The channels.
    pub channels: Vec<Channel>,
    /// A campaign for each time.
    pub rows: Vec<SweptCampaign>,
}

/// The best campaign of a time.
#[derive(Debug, Clone, PartialEq)]
pub struct SweptCampaign {
    /// The time, min.
    pub budget_min: f64,
    /// Its cycles.
    pub cycles: usize,
    /// The best campaign that was found, and the bound.
    pub design: CampaignDesign,
}

impl CampaignSweep {
    /// The best campaign in each of these times; `done` is told how many there are.
    ///
    /// # Errors
    /// As [`design`](crate::design()) of the first time that is too short.
    pub fn over(
        campaign: &Campaign,
        cycles: RangeInclusive<usize>,
        budgets_min: &[f64],
        done: impl Fn(usize),
    ) -> Result<Self> {
        let mut rows = Vec::new();
        for budget_min in budgets_min {
            let here = Campaign { budget_min: *budget_min, ..campaign.clone() };
            let (best, design) = design_over_cycles(&here, cycles.clone())?;
            rows.push(SweptCampaign { budget_min: *budget_min, cycles: best.cycles, design });
            done(rows.len());
        }
        Ok(Self { channels: campaign.channels.clone(), rows })
    }
}
