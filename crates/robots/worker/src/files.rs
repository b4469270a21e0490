//! Files that the user saves, by the writers of `robot_io`.

use std::io;

use ch16_slam2d::graph::PoseGraph;
use robot_io::graph_file::GraphFile;
use robot_io::map_image::{MapImage, MapMode};
use robot_io::session::FILE_NAME;
use robot_io::trajectory::Trajectory;

/// Cell size of the saved map, m: Nav2's default.
pub const MAP_CELL_M: f64 = 0.05;
/// Cell size of the report's map, m.
pub const REPORT_CELL_M: f64 = 0.1;

/// All files that can be saved.
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

/// The pictures of the map; `map.yaml` refers to the first before any was saved.
pub const MAP_IMAGES: [&str; 2] = ["map.pgm", "map.png"];

/// Describes a write error; writing to memory normally has none.
fn in_words(problem: &io::Error) -> String {
    format!("the file cannot be written: {problem}")
}

/// The map's image, or the YAML file that refers to `image`.
///
/// # Errors
/// If it cannot be written.
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

/// The trajectory in the TUM format.
///
/// # Errors
/// If it cannot be written.
pub fn trajectory_file(trajectory: &Trajectory) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let written = trajectory.write_tum(&mut bytes);
    written.map_err(|problem| in_words(&problem))?;
    Ok(bytes)
}

/// The graph in the g2o format.
#[must_use]
pub fn graph_file(graph: &PoseGraph) -> Vec<u8> {
    GraphFile::from_pose_graph(graph).to_g2o().into_bytes()
}
