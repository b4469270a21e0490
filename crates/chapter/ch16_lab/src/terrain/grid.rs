//! Both landscapes on a grid of shifts.

use super::icp_row::IcpRow;
use super::ndt_row::NdtRow;
use super::{TerrainScene, TerrainSettings};

/// A cell of a landscape and its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Index along Δx.
    pub column: usize,
    /// Index along Δy.
    pub row: usize,
    /// Cost in m², or score.
    pub value: f64,
}

/// Cost and score on an n × n grid of shifts; recomputation reuses the buffers.
///
/// Values are row-major with Δy outer: cell `(column, row)` is at `row * n + column`.
#[derive(Clone, Debug, Default)]
pub struct Terrain {
    settings: TerrainSettings,
    icp_cost_m2: Vec<f64>,
    ndt_score: Vec<f64>,
    xs: Vec<f64>,
    ys: Vec<f64>,
    icp_row: IcpRow,
    ndt_row: NdtRow,
}

impl Terrain {
    /// Computes both landscapes of a scene.
    #[must_use]
    pub fn compute(scene: &TerrainScene, settings: &TerrainSettings) -> Self {
        let mut terrain = Self::default();
        terrain.recompute(scene, settings);
        terrain
    }

    /// Recomputes the landscapes for a scene in the same buffers.
    pub fn recompute(&mut self, scene: &TerrainScene, settings: &TerrainSettings) {
        self.begin(scene, settings);
        while self.compute_row() {}
    }

    /// Recomputes ICP's landscape for a new τ and keeps NDT's.
    ///
    /// Settings other than τ have to be those of the last [`Terrain::recompute`].
    pub fn recompute_icp(&mut self, scene: &TerrainScene, tau_m: f64) {
        self.settings.tau_m = tau_m;
        self.icp_row.prepare(scene.map(), &self.settings);
        self.icp_cost_m2.clear();
        for row in 0..self.settings.n {
            self.add_icp_row(self.settings.offset_m(row));
        }
    }

    /// Recomputes NDT's landscape for a new NDT of the scene and keeps ICP's.
    pub fn recompute_ndt(&mut self, scene: &TerrainScene) {
        self.ndt_row.prepare(scene.ndt(), &self.xs, &self.settings);
        self.ndt_score.clear();
        for row in 0..self.settings.n {
            self.add_ndt_row(self.settings.offset_m(row));
        }
    }

    /// Starts over without rows; [`Terrain::compute_row`] adds them.
    pub fn begin(&mut self, scene: &TerrainScene, settings: &TerrainSettings) {
        self.settings = *settings;
        self.icp_cost_m2.clear();
        self.ndt_score.clear();
        scene.turned_into(settings.heading_deg, &mut self.xs, &mut self.ys);
        self.icp_row.prepare(scene.map(), settings);
        self.ndt_row.prepare(scene.ndt(), &self.xs, settings);
    }

    /// Computes the next row of both landscapes. Returns false if all rows are finished.
    pub fn compute_row(&mut self) -> bool {
        let row = self.rows();
        if row >= self.settings.n {
            return false;
        }
        let dy = self.settings.offset_m(row);
        self.add_icp_row(dy);
        self.add_ndt_row(dy);
        true
    }

    fn add_icp_row(&mut self, dy: f64) {
        self.icp_row.begin();
        for (&x, &y) in self.xs.iter().zip(&self.ys) {
            self.icp_row.add_point(x, y + dy);
        }
        let count = self.xs.len().max(1) as f64;
        self.icp_cost_m2
            .extend(self.icp_row.sums().iter().map(|sum| sum / count));
    }

    fn add_ndt_row(&mut self, dy: f64) {
        self.ndt_row.begin();
        for (index, (&x, &y)) in self.xs.iter().zip(&self.ys).enumerate() {
            self.ndt_row.add_point(index, x, y + dy);
        }
        let count = self.xs.len().max(1) as f64;
        self.ndt_score
            .extend(self.ndt_row.sums().iter().map(|sum| sum / count));
    }

    /// The settings of the landscapes.
    #[must_use]
    pub fn settings(&self) -> &TerrainSettings {
        &self.settings
    }

    /// Number of finished rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.icp_cost_m2.len() / self.settings.n.max(1)
    }

    /// ICP's cost, m².
    #[must_use]
    pub fn icp_cost_m2(&self) -> &[f64] {
        &self.icp_cost_m2
    }

    /// NDT's score.
    #[must_use]
    pub fn ndt_score(&self) -> &[f64] {
        &self.ndt_score
    }

    /// The cell with the lowest ICP cost; the first one of a tie.
    #[must_use]
    pub fn icp_minimum(&self) -> Option<Peak> {
        self.best(&self.icp_cost_m2, |value, best| value < best)
    }

    /// The cell with the highest NDT score; the first one of a tie.
    #[must_use]
    pub fn ndt_maximum(&self) -> Option<Peak> {
        self.best(&self.ndt_score, |value, best| value > best)
    }

    fn best(&self, values: &[f64], better: impl Fn(f64, f64) -> bool) -> Option<Peak> {
        let (mut index, mut value) = (0, *values.first()?);
        for (candidate, &at) in values.iter().enumerate() {
            if better(at, value) {
                (index, value) = (candidate, at);
            }
        }
        Some(Peak {
            column: index % self.settings.n,
            row: index / self.settings.n,
            value,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::SceneKind;

    #[test]
    fn one_landscape_alone_has_the_bits_of_both_together() {
        let mut scene = TerrainScene::new(SceneKind::Room, 0.55);
        let settings = TerrainSettings {
            heading_deg: 7.0,
            ..TerrainSettings::default()
        };
        let mut terrain = Terrain::compute(&scene, &settings);
        terrain.recompute_icp(&scene, 0.25);
        scene.set_ndt_cell(0.8);
        terrain.recompute_ndt(&scene);
        let whole = Terrain::compute(
            &scene,
            &TerrainSettings {
                tau_m: 0.25,
                ..settings
            },
        );
        assert_eq!(terrain.icp_cost_m2(), whole.icp_cost_m2());
        assert_eq!(terrain.ndt_score(), whole.ndt_score());
        assert_eq!(terrain.settings(), whole.settings());
    }
}
