//! The chapter's computations: their list, and the runs of the lap.

use ch16_lab::lap::{LapConfig, LapRecord, LapRunner};
use ch16_lab::samples;
use ch16_slam2d::icp::IcpVariant;

use crate::scans::{
    QUERIES, ndt_build, ndt_registration, nearest_in_dense_map, nearest_in_table,
    nearest_in_voxel_map, normals, register_with_table, register_without_table, sweep, table,
    terrain,
};
use crate::search::search;
use crate::{Limit, Run, Workload, prepared};

const fn limit(native_ms: f64, wasm_ms: f64) -> Option<Limit> {
    Some(Limit { native_ms, wasm_ms })
}

/// The workloads, one per computation.
#[must_use]
pub fn workloads() -> Vec<Workload> {
    let workload = |id, what, limit, prepare| Workload {
        id,
        what,
        repetitions: 1,
        limit,
        most_of_native: None,
        prepare,
    };
    let query = |id, what, limit, prepare| Workload {
        repetitions: QUERIES as u32,
        most_of_native: Some(1.5),
        ..workload(id, what, limit, prepare)
    };
    vec![
        Workload {
            most_of_native: Some(1.6),
            ..workload(
                "lap",
                "the canonical lap, simulated and estimated, with its front end alone and all metrics",
                limit(12.0, 25.0),
                lap,
            )
        },
        workload(
            "register-p2p",
            "one registration, 155 points, 30 iterations, point-to-point, on the table",
            limit(0.15, 0.3),
            || register_with_table(IcpVariant::PointToPoint),
        ),
        workload(
            "register-p2l",
            "one registration, 155 points, 30 iterations, point-to-plane, on the table",
            limit(0.15, 0.3),
            || register_with_table(IcpVariant::PointToPlane),
        ),
        workload(
            "register-p2p-map",
            "the same, point-to-point, on the dense map: no table",
            None,
            || register_without_table(IcpVariant::PointToPoint),
        ),
        workload(
            "register-p2l-map",
            "the same, point-to-plane, on the dense map: no table",
            None,
            || register_without_table(IcpVariant::PointToPlane),
        ),
        workload(
            "table",
            "the table of nearest neighbours, built",
            None,
            table,
        ),
        workload(
            "sweep-p2p",
            "basin sweep, 361 headings, point-to-point, scene and table built",
            limit(30.0, 60.0),
            || sweep(IcpVariant::PointToPoint),
        ),
        workload(
            "sweep-p2l",
            "basin sweep, 361 headings, point-to-plane, scene and table built",
            limit(30.0, 60.0),
            || sweep(IcpVariant::PointToPlane),
        ),
        workload(
            "terrain-49",
            "cost terrain of the room, 49 × 49, both objectives",
            limit(4.0, 8.0),
            || terrain(49),
        ),
        workload(
            "terrain-161",
            "cost terrain of the room, 161 × 161, both objectives",
            limit(40.0, 80.0),
            || terrain(161),
        ),
        workload(
            "ndt-build",
            "NDT of one sweep, cells of 0.5 m",
            None,
            ndt_build,
        ),
        workload(
            "ndt-align",
            "NDT registration of one sweep",
            None,
            ndt_registration,
        ),
        query(
            "nearest-table",
            "nearest neighbour within 0.5 m, map of 5,000 points, a query: table",
            None,
            nearest_in_table,
        ),
        query(
            "nearest",
            "the same, dense map",
            limit(90e-6, 150e-6),
            nearest_in_dense_map,
        ),
        query(
            "nearest-voxel",
            "the same, voxel map",
            None,
            nearest_in_voxel_map,
        ),
        workload(
            "search",
            "a window searched, ±3 m and every heading at 5 cm, on a submap of the Apartment",
            limit(15.0, 30.0),
            search,
        ),
        workload("normals", "normals of 720 points", None, normals),
        workload(
            "solve",
            "pose graph of the lap, 41 nodes, 15 iterations at most",
            None,
            solve,
        ),
        workload(
            "grid",
            "occupancy grid of the lap's keyframes, drawn again",
            None,
            grid,
        ),
    ]
}

fn lap() -> Box<dyn Run> {
    prepared(
        None,
        // A runner with an earlier drive would skip the simulation.
        |record: &mut Option<LapRecord>| {
            *record = Some(LapRunner::new().run(&LapConfig::default()));
        },
        |record, digest| {
            if let Some(record) = record {
                digest.add_bits(record.digest());
            }
        },
    )
}

fn solve() -> Box<dyn Run> {
    let graph = samples::lap_graph();
    let start = graph.poses().to_vec();
    prepared(
        (graph, start),
        |(graph, start)| {
            for (node, pose) in start.iter().enumerate() {
                graph.set_pose(node, *pose);
            }
            graph.optimize_robust(15, 1e-7, 12.0);
        },
        |(graph, _), digest| graph.poses().iter().for_each(|pose| digest.add_pose(pose)),
    )
}

fn grid() -> Box<dyn Run> {
    let record = LapRunner::new().run(&LapConfig::default());
    prepared(
        (record, None),
        |(record, grid)| *grid = Some(record.occupancy_grid(record.ticks())),
        |(_, grid), digest| {
            if let Some(grid) = grid {
                digest.add_all(grid.log_odds());
            }
        },
    )
}
