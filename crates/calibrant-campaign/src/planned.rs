//! A designed campaign with all that its file and its page show.

use crate::{Campaign, CampaignDesign, TimedSoak, UsualCampaign};

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
}
