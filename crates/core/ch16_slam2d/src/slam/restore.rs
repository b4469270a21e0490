//! Takes the state of an estimator, and continues from it.

use super::{Slam, SlamSnapshot, SnapshotError, Strategies};

impl Slam {
    /// The state of the estimator between two frames.
    #[must_use]
    pub fn snapshot(&self) -> SlamSnapshot {
        SlamSnapshot {
            config: self.config.clone(),
            frames: self.frames,
            last_stamp_s: self.last_stamp_s,
            nodes: self.graph().nodes().map(|(_, node)| node).collect(),
            edges: self.graph().edges().collect(),
            optimized_edges: self.graph().optimized_edges(),
            keyframes: self.keyframes().to_vec(),
            last_attempt_node: self.loop_closer.last_attempt_node,
            last_loop_node: self.mapper.last_loop_node(),
            pending: self.loop_closer.pending().to_vec(),
            front_end: self.front_end.snapshot(),
        }
    }

    /// [`Slam::restore`] with custom strategies.
    ///
    /// # Errors
    /// If the snapshot is inconsistent.
    pub fn restore_with(
        snapshot: &SlamSnapshot,
        strategies: Strategies,
    ) -> Result<Self, SnapshotError> {
        snapshot.check()?;
        let mut slam = Self::with(snapshot.config.clone(), strategies);
        slam.frames = snapshot.frames;
        slam.last_stamp_s = snapshot.last_stamp_s;
        slam.mapper.restore(snapshot);
        slam.loop_closer
            .restore(snapshot.last_attempt_node, &snapshot.pending)?;
        slam.front_end.restore(&snapshot.front_end)?;
        Ok(slam)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::EdgeKind;
    use crate::slam::test_room::{doubting, frame};
    use crate::slam::{NamedNumbers, SlamConfig};
    use pr_geom::SE2;

    fn run(slam: &mut Slam, steps: core::ops::Range<usize>) {
        for step in steps {
            slam.step(&frame(step)).unwrap();
        }
    }

    fn configs() -> [SlamConfig; 4] {
        let scan = frame(0).scan;
        [
            doubting(),
            SlamConfig::for_robot(&scan),
            SlamConfig::default(),
            SlamConfig::chapter(),
        ]
    }

    #[test]
    fn an_interrupted_run_ends_in_the_same_bits() {
        let (mut waited, mut unspread) = (0, 0);
        for config in configs() {
            let mut whole = Slam::new(config.clone());
            run(&mut whole, 0..200);
            // Before the first loop, between loops, after the first frame, before it.
            for stop in [0, 1, 60, 121, 150, 160, 170, 180] {
                let mut first = Slam::new(config.clone());
                run(&mut first, 0..stop);
                waited += first.snapshot().pending.len();
                let graph = first.graph();
                let newer = graph.edges().skip(graph.optimized_edges());
                unspread += newer
                    .filter(|view| view.edge.kind == EdgeKind::Loop)
                    .count();
                let mut second = Slam::restore(&first.snapshot()).unwrap();
                run(&mut second, stop..200);
                assert_eq!(second.snapshot(), whole.snapshot(), "stopped after {stop}");
                assert_eq!(second.chi2().to_bits(), whole.chi2().to_bits());
            }
        }
        assert!(
            waited > 0,
            "no run was interrupted while a loop was pending"
        );
        assert!(unspread > 0, "none while a correction was postponed");
    }

    #[test]
    fn an_inconsistent_snapshot_is_rejected_with_a_message() {
        let mut slam = Slam::new(SlamConfig::default());
        run(&mut slam, 0..30);
        let good = slam.snapshot();
        assert_eq!(good.check(), Ok(()));
        type Spoil = fn(&mut SlamSnapshot);
        let spoils: [(Spoil, &str); 9] = [
            (
                |s| drop(s.keyframes.pop()),
                "keyframes; each node needs one",
            ),
            (|s| s.nodes[0].fixed = false, "no node is fixed"),
            (
                |s| s.edges[0].to = 999.into(),
                "edge 0 connects node 0 to 999",
            ),
            (
                |s| s.nodes[1].pose = SE2::from_xy(f64::NAN, 0.0),
                "node 1 has",
            ),
            (|s| s.last_loop_node = 999, "newest node with a loop"),
            (|s| s.optimized_edges = 999, "number of optimized edges"),
            (|s| drop(s.front_end.scans.pop()), "window of sweeps"),
            (
                |s| {
                    let numbers = std::mem::take(&mut s.front_end.registrar);
                    s.front_end.registrar = numbers.with("deviations", &[f64::INFINITY, 1.0]);
                },
                "front end 0",
            ),
            (
                |s| s.front_end.registrar = NamedNumbers::default(),
                "no valid deviations",
            ),
        ];
        for (spoil, expected) in spoils {
            let mut bad = good.clone();
            spoil(&mut bad);
            let error = Slam::restore(&bad).err().unwrap().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
