//! The bias of each method over the share of the box, one scene at a time.

use ch16_lab::moving_box::{BoxConfig, BoxErrors, BoxMethods, BoxScene};
use ch16_slam2d::icp::IcpWorkspace;
use widget_kit::model::Activity;

use crate::w16_8_moving_box::spec::MAX_SHARE;

/// Step between the shares of the curves, %.
const SHARE_STEP: f64 = 10.0;
/// Number of seeds at each point of the curves.
pub const SEEDS: usize = 100;

/// The curves; all shares have equally many seeds, except during a pass.
pub struct Curves {
    /// Their settings.
    key: (BoxMethods, [f64; 2]),
    errors: Vec<BoxErrors>,
    /// The scene under way, and how many methods have registered it.
    under_way: Option<(BoxScene, usize)>,
    /// Scenes done.
    done: usize,
}

/// Shares of the curves, %.
pub fn shares() -> impl ExactSizeIterator<Item = f64> {
    let count = (MAX_SHARE / SHARE_STEP) as usize + 1;
    (0..count).map(|k| SHARE_STEP * k as f64)
}

impl Curves {
    /// Curves without seeds.
    pub fn new(methods: BoxMethods, moved_m: [f64; 2]) -> Self {
        Self {
            key: (methods, moved_m),
            errors: vec![BoxErrors::default(); shares().len()],
            under_way: None,
            done: 0,
        }
    }

    /// Starts over if the settings changed.
    pub fn follow(&mut self, methods: BoxMethods, moved_m: [f64; 2]) {
        if self.key != (methods, moved_m) {
            *self = Self::new(methods, moved_m);
        }
    }

    /// Creates two sweeps or does one registration of the next share: every share gets its first seed before
    /// any gets a second.
    pub fn work(&mut self, workspace: &mut IcpWorkspace) -> Activity {
        let count = self.errors.len();
        let (seed, k) = (self.done / count, self.done % count);
        if seed == SEEDS {
            return Activity::Idle;
        }
        let (methods, moved_m) = self.key;
        let Some((scene, method)) = &mut self.under_way else {
            let scene = BoxScene::new(&BoxConfig {
                seed: seed as u32 + 1,
                share: SHARE_STEP * k as f64 / 100.0,
                moved_m,
            });
            self.under_way = Some((scene, 0));
            return Activity::Busy;
        };
        self.errors[k].add_one(scene, &methods, *method, workspace);
        *method += 1;
        if *method == BoxMethods::NAMES.len() {
            self.under_way = None;
            self.done += 1;
        }
        Activity::Busy
    }

    /// Number of seeds that all shares have.
    pub fn seeds(&self) -> usize {
        self.done / self.errors.len()
    }

    /// Finished share of the scenes.
    pub fn progress(&self) -> f64 {
        self.done as f64 / (SEEDS * self.errors.len()) as f64
    }

    /// Bias of a method over the shares in percent, m; `None` before the first seed.
    pub fn bias_m(&self, method: usize) -> impl Iterator<Item = (f64, Option<f64>)> + '_ {
        shares().zip(self.errors.iter().map(move |errors| errors.bias_m(method)))
    }
}
