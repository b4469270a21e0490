//! The types of the functions: a type of the student's own could be equal to every expected number.

use ch16_listings::{
    Correspondence, IcpConfig, IcpResult, LoopConfig, PointCloud, PoseGraph, SE2, VerifiedLoop,
    VoxelMap,
};
use nalgebra::{Matrix3, Point2, Vector3};
use petgraph::graph::NodeIndex;

type Histogram = [f64; 64];
type Points = [Point2<f64>];

const _: fn(&Points, &Points) -> SE2 = exercises::svd_align;
const _: fn(&[Correspondence]) -> SE2 = exercises::point_to_plane_step;
const _: fn(&SE2, &SE2, &SE2) -> Vector3<f64> = exercises::residual;
const _: fn(&SE2) -> (Matrix3<f64>, Matrix3<f64>) = exercises::jacobians;
const _: fn(&mut PoseGraph, f64) -> f64 = exercises::optimize_once;
const _: fn(&mut PoseGraph, usize, f64, f64) -> usize = exercises::optimize;
const _: fn(&PointCloud, &VoxelMap, SE2, &IcpConfig) -> IcpResult = exercises::icp;
const _: fn(&PoseGraph, &[PointCloud], NodeIndex, NodeIndex, &LoopConfig) -> VerifiedLoop =
    exercises::verify_loop;
const _: fn(&PointCloud, f64) -> Histogram = exercises::range_histogram;
const _: fn(&Histogram, &Histogram) -> f64 = exercises::chi2_distance;
const _: fn(&[PointCloud], usize, usize, f64, f64) -> Vec<usize> = exercises::detect_by_histogram;
