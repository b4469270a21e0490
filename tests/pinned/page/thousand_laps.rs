//! The table of the thousand laps that the page links to agrees with the core.

use super::document::source;
use super::figures::recorded;

/// Levels of the odometry noise, and the columns and rows of the table, by the names of figures and of the
/// file.
const LEVELS: [&str; 4] = ["quarter", "once", "double", "fourfold"];
const COLUMNS: [(&str, &str); 3] = [
    ("odometry", "odometry"),
    ("front_end", "front end"),
    ("with_loops", "with loops"),
];
const ROWS: [(&str, &str); 6] = [
    ("end_error", "position error of the last keyframe"),
    ("rms", "rms position error"),
    ("last_nine_min", "least error of the last nine keyframes"),
    ("last_nine_max", "largest error of the last nine keyframes"),
    ("max_error", "largest keyframe error"),
    ("map_disagreement", "map disagreement"),
];
const QUANTILES: [(&str, &str); 3] = [("low", "p05"), ("median", "median"), ("high", "p95")];
const COUNTS: [(&str, &str, usize, &str); 7] = [
    ("loops.0", "runs that close no loop", 1, "%"),
    ("loops.1", "runs that close one loop", 1, "%"),
    ("loops.2", "runs that close two loops", 1, "%"),
    ("loops.3", "runs that close three or more", 1, "%"),
    ("accepted", "closures accepted", 0, ""),
    (
        "false",
        "of these false: off by more than 0.3 m or 5 degrees",
        0,
        "",
    ),
    ("false_runs_percent", "runs with a false one", 1, "%"),
];

#[test]
fn the_table_behind_the_link_agrees_with_the_core() {
    let value = |name: &str| recorded::value(&format!("sweep.{name}"));
    let mut lines = vec!["wheel noise,estimate,result,statistic,value,unit".to_owned()];
    for level in LEVELS {
        let noise = value(&format!("{level}.noise")).expect("a level");
        for (column, estimate) in COLUMNS {
            for (row, result) in ROWS {
                for (quantile, statistic) in QUANTILES {
                    // Dead reckoning has no keyframes and no map.
                    if let Some(value) = value(&format!("{level}.{column}.{row}.{quantile}")) {
                        lines.push(format!(
                            "{noise},{estimate},{result},{statistic},{value:.2},m"
                        ));
                    }
                }
            }
        }
        for (name, result, decimals, unit) in COUNTS {
            let value = value(&format!("{level}.{name}")).expect("a count");
            lines.push(format!(
                "{noise},with loops,{result},count,{value:.decimals$},{unit}"
            ));
        }
    }
    let expected = lines.join("\n") + "\n";
    let file = source("web/page/thousand-laps.csv");
    assert!(
        file == expected,
        "web/page/thousand-laps.csv should hold\n{expected}"
    );
    assert!(source("index.html").contains("href=\"thousand-laps.csv\" download"));
}
