//! A custom matcher: ICP from several headings, which keeps the best fit.
//!
//! `cargo run -p ch16_slam2d --example write_your_own_matcher`

use ch16_slam2d::chapter::ChapterParts;
use ch16_slam2d::matching::{IcpMatcher, Match, MatchRequest, Matcher};
use ch16_slam2d::prelude::*;
use ch16_slam2d::slam::{Slam, SlamConfig};

/// ICP from a coarse search over headings.
#[derive(Clone)]
pub struct ManyHeadings(pub IcpMatcher);

impl Matcher for ManyHeadings {
    fn set_target(&mut self, target: &PointCloud) {
        self.0.set_target(target);
    }

    fn register(&mut self, source: &PointCloud, request: &MatchRequest) -> Match {
        let mut from = |guess| self.0.register(source, &MatchRequest { guess, ..*request });
        let turns = [0.0, -0.8, -0.4, 0.4, 0.8].map(|turn_rad| SE2::new(0.0, 0.0, turn_rad));
        let found = turns.map(|turn| from(request.guess * turn));
        let by_fit = |a: &Match, b: &Match| a.summary.rmse_m.total_cmp(&b.summary.rmse_m);
        let best = found.into_iter().min_by(by_fit);
        best.unwrap_or_else(|| from(request.guess))
    }
}

/// The estimator with this matcher for its front end, and default parts otherwise.
pub fn slam(config: SlamConfig, matcher: ManyHeadings) -> Slam {
    let mut parts = ChapterParts::from_config(&config.chapter);
    parts.front_end = Box::new(matcher);
    Slam::with_parts(config, parts)
}

/// Heading error of a registration from a guess that is off by 0.9 rad.
pub fn off_rad(matcher: &mut dyn Matcher) -> f64 {
    let side = |k: i32| 0.05 * f64::from(k);
    let walls = |k| [[side(k), 0.0], [0.0, side(k)], [side(k), 2.0]];
    let room: PointCloud = (1..60).flat_map(walls).map(Point2::from).collect();
    matcher.set_target(&room);
    let scan = room.transformed(&SE2::new(1.2, 0.9, 0.9).inverse());
    let request = MatchRequest::new(SE2::new(1.2, 0.9, 0.0), 1.0, 99);
    matcher.register(&scan, &request).summary.pose.theta() - 0.9
}

/// Prints the heading error of the matcher above.
pub fn main() {
    let config = SlamConfig::default();
    let mut many = ManyHeadings(IcpMatcher::with_variant(
        IcpVariant::PointToPoint,
        &config.chapter.local_map,
    ));
    println!("many headings are off by {:.3} rad", off_rad(&mut many));
    println!("frames so far: {}", slam(config, many).frames());
}
