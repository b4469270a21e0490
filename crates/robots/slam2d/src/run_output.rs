//! Files of `slam2d run -o DIR` for other tools and for viewing.
//!
//! | file | content |
//! |---|---|
//! | `trajectory.tum` | the pose of every scan |
//! | `quality.json`, `report.txt` | reliability of keyframes and loops, and doubts |
//! | `session.slam2d` | the complete state: input of `--continue`, `slam2d localize` and `slam2d map` |
//! | `graph.g2o` | the pose graph |
//! | `keyframes.jsonl` | the keyframes' scans with their poses: input of `slam2d map` |
//! | `report.html` | keyframes, loops and doubts with pictures |
//! | `map.pgm`, `map.yaml` | the map for Nav2's map_server |
//! | `map.png` | the same map for viewing |

use std::io::Write;
use std::path::Path;

use robot_io::graph_file::GraphFile;
use robot_io::map_image::{MapMode, NoReturn};
use robot_io::quality::Quality;
use robot_io::report::LogReport;
use robot_io::run::LogRun;
use robot_io::session::FILE_NAME;

use crate::run_folder::{KEYFRAMES, QUALITY, RunFolder};

/// Cell size of the report, m: finer cells are not visible in its picture.
const REPORT_CELL_M: f64 = 0.1;

/// What a run leaves.
pub struct Results<'a> {
    /// Name of the log.
    pub log: &'a str,
    /// The run after its end.
    pub run: &'a LogRun,
    /// Its quality.
    pub quality: &'a Quality,
    /// Sentences on the recording.
    pub remarks: &'a [String],
    /// Side of the map's cells, m.
    pub cell_m: f64,
    /// What beams without a return say on the map.
    pub no_return: NoReturn,
    /// Whether the run reached the end of the log.
    pub is_whole: bool,
}

/// Writes all files to a folder, which is created if needed; returns what is to be said about the map.
///
/// # Errors
/// If the system cannot write a file; the error contains the name, and nothing is replaced.
pub fn write_folder(folder: &Path, results: &Results<'_>) -> anyhow::Result<Option<String>> {
    let Results { run, quality, .. } = results;
    let into = RunFolder::create(folder)?;
    into.save("trajectory.tum", |out| run.trajectory().write_tum(out))?;
    into.save(QUALITY, |out| Ok(serde_json::to_writer(out, quality)?))?;
    into.save("report.txt", |out| {
        out.write_all(report(run, quality).as_bytes())
    })?;
    if let Some(session) = run.session() {
        into.save(FILE_NAME, |out| out.write_all(&session.to_bytes()))?;
    }
    if let Some(slam) = run.slam() {
        into.save("graph.g2o", |out| {
            out.write_all(GraphFile::from_pose_graph(slam.graph()).to_g2o().as_bytes())
        })?;
    }
    into.save(KEYFRAMES, |out| {
        run.map_lines()
            .iter()
            .try_for_each(|line| line.write(&mut *out))
    })?;
    let said = match run.map(results.cell_m, results.no_return) {
        Ok(map) => {
            into.save("map.pgm", |out| map.write_pgm(out))?;
            into.save("map.png", |out| map.write_png(out, MapMode::Trinary))?;
            into.save("map.yaml", |out| {
                out.write_all(map.yaml("map.pgm", MapMode::Trinary).as_bytes())
            })?;
            map.coarser_than(results.cell_m)
        }
        Err(problem) => Some(format!("no map was written: {problem}")),
    };
    let map = run.map(REPORT_CELL_M, results.no_return);
    let mut remarks = results.remarks.to_vec();
    remarks.extend(said.clone());
    let html = LogReport {
        name: results.log,
        scans: run.scans(),
        quality,
        chi2_over_time: run.chi2_over_time(),
        map: map.as_ref(),
        remarks: &remarks,
    }
    .html();
    into.save("report.html", |out| out.write_all(html.as_bytes()))?;
    if results.is_whole {
        into.forget_parts();
    }
    into.finish()?;
    Ok(said)
}

/// The quality report as text.
fn report(run: &LogRun, quality: &Quality) -> String {
    let mut text = format!(
        "{} scans, {} keyframes, {} loops in the graph\n\n",
        run.scans(),
        quality.keyframes.len(),
        quality.links.len()
    );
    if quality.doubts.is_empty() {
        text.push_str("No doubts.\n");
    } else {
        text.push_str("Doubts:\n");
    }
    for doubt in &quality.doubts {
        text.push_str(&format!("- {doubt}\n"));
    }
    text.push_str("\nLoops: from, to, score, RMSE (m), inliers, chi-squared (gate)\n");
    for link in &quality.links {
        let number = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.3}"));
        text.push_str(&format!(
            "{} {} {} {} {} {} ({:.1})\n",
            link.from,
            link.to,
            number(link.score),
            number(link.rmse_m),
            link.inliers,
            number(link.chi2),
            link.gate_chi2
        ));
    }
    text
}
