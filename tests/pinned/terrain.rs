//! w16.3: both landscapes of `terrain.json`, cell by cell.

use ch16_lab::terrain::{SceneKind, Terrain, TerrainScene, TerrainSettings};
use serde::Deserialize;
use slam2d_tests::{assert_close, reference};

#[derive(Deserialize)]
struct Landscape {
    scene: String,
    tau: f64,
    n: usize,
    span_m: f64,
    points: usize,
    ndt_cells: usize,
    icp_cost_m2: Vec<f64>,
    ndt_score: Vec<f64>,
}

#[test]
fn every_cell_of_both_landscapes_has_the_reference_value() {
    let expected: Vec<Landscape> = reference("terrain.json");
    assert!(!expected.is_empty());
    for expected in &expected {
        let kind = match expected.scene.as_str() {
            "room" => SceneKind::Room,
            "corridor" => SceneKind::Corridor,
            other => panic!("unknown scene {other}"),
        };
        let scene = TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M);
        assert_eq!(scene.cloud().len(), expected.points);
        assert_eq!(scene.ndt().cells().len(), expected.ndt_cells);
        let settings = TerrainSettings {
            n: expected.n,
            span_m: expected.span_m,
            tau_m: expected.tau,
            ..TerrainSettings::default()
        };
        let terrain = Terrain::compute(&scene, &settings);
        assert_eq!(terrain.icp_cost_m2().len(), expected.icp_cost_m2.len());
        assert_eq!(terrain.ndt_score().len(), expected.ndt_score.len());
        for cell in 0..expected.n * expected.n {
            let name = format!("{} cell {cell}", expected.scene);
            let (cost, score) = (terrain.icp_cost_m2()[cell], terrain.ndt_score()[cell]);
            assert_close(&name, cost, expected.icp_cost_m2[cell], 1e-9);
            assert_close(&name, score, expected.ndt_score[cell], 1e-9);
        }
    }
}
