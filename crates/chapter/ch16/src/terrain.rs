//! `ch16 terrain`: the cost landscapes of w16.3.

use ch16_lab::terrain::{SceneKind, Terrain, TerrainScene, TerrainSettings};
use clap::{Args, ValueEnum};
use serde::Serialize;

use command_line::numbers;
use command_line::output::{print_json, say};

/// Compute ICP's cost and NDT's score over shifts of the point cloud.
#[derive(Args, Clone, Debug)]
pub struct TerrainArgs {
    /// Scene of the scan.
    #[arg(long, value_enum, default_value_t = SceneName::Room)]
    scene: SceneName,
    /// Truncation of ICP's distances τ, m.
    #[arg(long, default_value = "0.6", value_parser = numbers::tau_m, allow_hyphen_values = true)]
    tau: f64,
    /// Shifts along each axis.
    #[arg(long, default_value = "49", value_parser = numbers::shifts, allow_hyphen_values = true)]
    n: usize,
    /// Print one JSON object, row-major with Δy outer.
    #[arg(long)]
    json: bool,
}

/// `--scene`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum SceneName {
    /// Room A.
    Room,
    /// The corridor.
    Corridor,
}

#[derive(Serialize)]
struct TerrainJson<'a> {
    scene: &'static str,
    #[serde(flatten)]
    settings: TerrainSettings,
    points: usize,
    ndt_cells: usize,
    icp_cost_m2: &'a [f64],
    ndt_score: &'a [f64],
}

/// Computes both landscapes and prints them.
pub fn run(args: &TerrainArgs) {
    let (kind, name) = match args.scene {
        SceneName::Room => (SceneKind::Room, "room"),
        SceneName::Corridor => (SceneKind::Corridor, "corridor"),
    };
    let scene = TerrainScene::new(kind, TerrainScene::DEFAULT_NDT_CELL_M);
    let settings = TerrainSettings {
        n: args.n,
        tau_m: args.tau,
        ..TerrainSettings::default()
    };
    let terrain = Terrain::compute(&scene, &settings);
    if args.json {
        print_json(&TerrainJson {
            scene: name,
            settings,
            points: scene.cloud().len(),
            ndt_cells: scene.ndt().cells().len(),
            icp_cost_m2: terrain.icp_cost_m2(),
            ndt_score: terrain.ndt_score(),
        });
        return;
    }
    say!(
        "{name}, tau {} m, {} points, {} NDT cells",
        args.tau,
        scene.cloud().len(),
        scene.ndt().cells().len()
    );
    for (what, peak) in [
        ("lowest ICP cost", terrain.icp_minimum()),
        ("highest NDT score", terrain.ndt_maximum()),
    ] {
        if let Some(peak) = peak {
            let (dx, dy) = (settings.offset_m(peak.column), settings.offset_m(peak.row));
            say!("{what:<18} {:.5} at ({dx:.3}, {dy:.3}) m", peak.value);
        }
    }
}
