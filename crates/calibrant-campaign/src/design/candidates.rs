//! The soaks that a campaign may consist of: temperature and direction (a place), wait, and number of blocks.
//!
//! What a soak measures depends on place and wait; how well, on wait and blocks. The gain of all is so the product of two small tables.

use crate::campaign::MOST_BLOCKS;
use crate::criterion::Gradient;
use crate::{Campaign, Direction, Soak};
use nalgebra::{DMatrix, DVector};

pub(super) struct Candidates {
    pub(super) places: Vec<(f64, Direction)>,
    pub(super) waits_min: Vec<f64>,
    /// Row of each channel, for each place and wait.
    rows: Vec<Vec<DVector<f64>>>,
    /// Inverse variance of each channel, for each wait and number of blocks.
    strengths: Vec<Vec<f64>>,
    block_min: f64,
}

impl Candidates {
    pub(super) fn of(campaign: &Campaign, temperatures_c: &[f64]) -> Self {
        let both = temperatures_c.iter().flat_map(|t| campaign.directions.iter().map(|d| (*t, *d)));
        let places: Vec<_> = both.collect();
        let waits_min = campaign.waits_min();
        let left: Vec<f64> = waits_min.iter().map(|wait| campaign.lag_left(*wait)).collect();
        let rows = campaign.channels.iter().map(|channel| {
            let row = |(t, d): &(f64, Direction), left: f64| channel.row(campaign.x(*t), d.sign(), left);
            places.iter().flat_map(|place| left.iter().map(move |left| row(place, *left))).collect()
        });
        let strengths = campaign.channels.iter().map(|channel| {
            let strength = |left: f64, blocks: usize| channel.variance(blocks, left).recip();
            left.iter().flat_map(|left| (1..=MOST_BLOCKS).map(move |n| strength(*left, n))).collect()
        });
        let (rows, strengths) = (rows.collect(), strengths.collect());
        Self { places, waits_min, rows, strengths, block_min: campaign.block_min }
    }

    /// Number of choices of wait and blocks at a place.
    pub(super) fn choices(&self) -> usize {
        self.waits_min.len() * MOST_BLOCKS
    }

    pub(super) fn len(&self) -> usize {
        self.places.len() * self.choices()
    }

    pub(super) fn soak(&self, index: usize) -> Soak {
        let (temperature_c, direction) = self.places[index / self.choices()];
        let wait_min = self.waits_min[index % self.choices() / MOST_BLOCKS];
        Soak { temperature_c, direction, wait_min, blocks: index % MOST_BLOCKS + 1 }
    }

    pub(super) fn minutes(&self, index: usize) -> f64 {
        let wait_min = self.waits_min[index % self.choices() / MOST_BLOCKS];
        wait_min + (index % MOST_BLOCKS + 1) as f64 * self.block_min
    }

    /// Row and inverse variance of each channel.
    pub(super) fn of_channels(&self, index: usize) -> impl Iterator<Item = (&DVector<f64>, f64)> {
        let (row, strength) = (index / MOST_BLOCKS, index % self.choices());
        self.rows.iter().zip(&self.strengths).map(move |(rows, strengths)| (&rows[row], strengths[strength]))
    }

    /// The information of these numbers of soaks about each channel.
    pub(super) fn information(&self, soaks: &[(usize, f64)]) -> Vec<DMatrix<f64>> {
        let size = |rows: &Vec<DVector<f64>>| rows[0].len();
        let mut sum: Vec<_> = self.rows.iter().map(|rows| DMatrix::zeros(size(rows), size(rows))).collect();
        for &(index, count) in soaks {
            for ((row, strength), sum) in self.of_channels(index).zip(&mut sum) {
                sum.ger(count * strength, row, row, 1.0);
            }
        }
        sum
    }

    /// How fast one soak of each candidate lowers the criterion: `Σ_c v fᵀ G f`.
    pub(super) fn gains(&self, gradients: &[Gradient]) -> Vec<f64> {
        let mut gains = vec![0.0; self.len()];
        for ((rows, strengths), of) in self.rows.iter().zip(&self.strengths).zip(gradients) {
            for (k, row) in rows.iter().enumerate() {
                let square = (&of.gradient * row).dot(row);
                let wait = k % self.waits_min.len();
                let first = k * MOST_BLOCKS;
                for (n, gain) in gains[first..first + MOST_BLOCKS].iter_mut().enumerate() {
                    *gain += square * strengths[wait * MOST_BLOCKS + n];
                }
            }
        }
        gains
    }
}
