//! What the reader saves, by the writers of `robot_io`.

use std::io;

use ch16_slam2d::graph::PoseGraph;
use robot_io::graph_file::GraphFile;
use robot_io::map_image::{MapImage, MapMode};
use robot_io::session::FILE_NAME;
use robot_io::trajectory::Trajectory;

/// Side of the saved map's cells, m: what Nav2's maps have.
pub const MAP_CELL_M: f64 = 0.05;
/// Side of the report's cells, m.
pub const REPORT_CELL_M: f64 = 0.1;

/// Every file that can be saved.
pub const NAMES: [&str; 8] = [
    "map.pgm",
    "map.png",
    "map.yaml",
    "trajectory.tum",
    "graph.g2o",
    "report.html",
    FILE_NAME,
    "where.tum",
];

/// The pictures of the map; the first is what `map.yaml` names before any was saved.
pub const MAP_IMAGES: [&str; 2] = ["map.pgm", "map.png"];

/// What goes wrong where memory takes what is written: nothing that a writer could tell.
fn in_words(problem: &io::Error) -> String {
    format!("the file cannot be written: {problem}")
}

/// The map's image, or the text that names `image`.
///
/// # Errors
/// Where it cannot be written.
pub fn map_file(map: &MapImage, name: &str, image: &str) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let written = match name {
        "map.pgm" => map.write_pgm(&mut bytes),
        "map.png" => map.write_png(&mut bytes, MapMode::Trinary),
        _ => return Ok(map.yaml(image, MapMode::Trinary).into_bytes()),
    };
    written.map_err(|problem| in_words(&problem))?;
    Ok(bytes)
}

/// TUM lines.
///
/// # Errors
/// Where they cannot be written.
pub fn trajectory_file(trajectory: &Trajectory) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let written = trajectory.write_tum(&mut bytes);
    written.map_err(|problem| in_words(&problem))?;
    Ok(bytes)
}

/// The graph for g2o.
#[must_use]
pub fn graph_file(graph: &PoseGraph) -> Vec<u8> {
    GraphFile::of_graph(graph).to_g2o().into_bytes()
}
