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
            searches: self.loop_closer.searches(),
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
        slam.loop_closer.restore(
            snapshot.last_attempt_node,
            &snapshot.pending,
            &snapshot.searches,
        )?;
        slam.front_end.restore(&snapshot.front_end)?;
        Ok(slam)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::EdgeKind;
    use crate::local_map::SubmapLoops;
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
        let (mut waited, mut unspread, mut unsearched) = (0, 0, 0);
        for config in configs() {
            let mut whole = Slam::new(config.clone());
            run(&mut whole, 0..200);
            // Before the first loop, between loops, after the first frame, before it.
            for stop in [0, 1, 60, 121, 150, 160, 170, 180] {
                let mut first = Slam::new(config.clone());
                run(&mut first, 0..stop);
                waited += first.snapshot().pending.len();
                unsearched += first.snapshot().searches.scans;
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
        assert!(unsearched > 0, "none in the middle of a search");
    }

    #[test]
    fn no_scan_evaluates_more_poses_than_its_budget() {
        const BUDGET: u64 = 100;
        let config = doubting();
        let mut strategies = Strategies::from_config(&config);
        let finder = SubmapLoops::new(&config.local_map.unwrap()).with_budget(BUDGET);
        strategies.finder = Box::new(finder);
        let mut slam = Slam::with(config, strategies);
        let (mut evaluated, mut most) = (0, 0);
        for step in 0..200 {
            let frame = slam.prepare(&frame(step)).unwrap();
            let mut pending = slam.begin(&frame).unwrap();
            let is_keyframe = pending.new_keyframe().is_some();
            let (mapper, config) = (&mut slam.mapper, &slam.config);
            let tried = slam.loop_closer.find(mapper, config, is_keyframe);
            evaluated += tried.evaluated;
            most = most.max(tried.evaluated);
            pending.add(step, tried);
            slam.close_loop(&mut pending);
        }
        assert!(most <= BUDGET, "{most}");
        // Many scans have used up their share.
        assert!(evaluated > 20 * BUDGET, "{evaluated}");
    }

    #[test]
    fn an_inconsistent_snapshot_is_rejected_with_a_message() {
        let mut slam = Slam::new(SlamConfig::default());
        run(&mut slam, 0..30);
        let good = slam.snapshot();
        assert_eq!(good.check(), Ok(()));
        type Spoil = fn(&mut SlamSnapshot);
        let spoils: [(Spoil, &str); 10] = [
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
            (|s| s.searches.due.push(999), "node of a due search"),
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
