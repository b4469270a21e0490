use super::*;
use proptest::prelude::*;

fn example() -> (SE2, SE2, Between) {
    let from = SE2::new(1.0, -0.4, 2.9);
    let to = SE2::new(0.2, 0.7, -2.4);
    let factor = Between {
        from: 0,
        to: 1,
        measurement: SE2::new(1.3, 0.2, 0.3),
        information: Matrix3::new(40.0, 3.0, -2.0, 3.0, 25.0, 5.0, -2.0, 5.0, 90.0),
    };
    (from, to, factor)
}

fn symmetric(upper: [f64; 6]) -> Matrix3<f64> {
    let [xx, xy, xt, yy, yt, tt] = upper;
    Matrix3::new(xx, xy, xt, xy, yy, yt, xt, yt, tt)
}

#[test]
fn residual_is_the_log_of_the_error_motion() {
    let (from, to, factor) = example();
    let expected = (factor.measurement.inverse() * from.between(&to)).log();
    let residual =
        PreparedFactor::new(&factor).residual(&PreparedPose::new(&from), &PreparedPose::new(&to));
    assert!((residual - expected).norm() < 1e-14);
}

#[test]
fn log_curvature_is_continuous_at_the_end_of_the_series() {
    let below = log_curvature(0.5 - 1e-14);
    let above = log_curvature(0.5 + 1e-14);
    // 2e-15: the closed form loses a few bits in 1 − x.
    assert!((below - above).abs() < 2e-15);
    assert_eq!(log_curvature(0.0), 1.0 / 12.0);
}

/// Derivatives of the residual with respect to both poses, by central differences.
fn numeric_jacobians(factor: &Between, from: &SE2, to: &SE2) -> (Matrix3<f64>, Matrix3<f64>) {
    let prepared = PreparedFactor::new(factor);
    let residual =
        |from: &SE2, to: &SE2| prepared.residual(&PreparedPose::new(from), &PreparedPose::new(to));
    let h = 1e-6;
    let columns = |change: &dyn Fn(Vector3<f64>) -> Vector3<f64>| {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        Matrix3::from_columns(&axes.map(|axis| (change(axis * h) - change(axis * -h)) / (2.0 * h)))
    };
    (
        columns(&|delta| residual(&from.boxplus(&delta), to)),
        columns(&|delta| residual(from, &to.boxplus(&delta))),
    )
}

/// Largest difference between the blocks and gradients and those by finite differences, as a share of the
/// largest entry.
fn mismatch(factor: &Between, from: &SE2, to: &SE2, model: JacobianModel) -> f64 {
    let (jacobian_from, jacobian_to) = numeric_jacobians(factor, from, to);
    let prepared = PreparedFactor::new(factor);
    let (from, to) = (PreparedPose::new(from), PreparedPose::new(to));
    let got = prepared.linearize(&from, &to, model, RobustKernel::None);
    let omega = factor.information;
    let weighted = omega * prepared.residual(&from, &to);
    let blocks = [
        (
            symmetric(got.from_from),
            jacobian_from.transpose() * omega * jacobian_from,
        ),
        (
            Matrix3::from_column_slice(&got.to_from),
            jacobian_to.transpose() * omega * jacobian_from,
        ),
        (
            symmetric(got.to_to),
            jacobian_to.transpose() * omega * jacobian_to,
        ),
    ];
    let gradients = [
        (got.gradient_from, jacobian_from.transpose() * weighted),
        (got.gradient_to, jacobian_to.transpose() * weighted),
    ];
    let of_blocks = blocks.map(|(got, numeric)| (got - numeric).amax() / (1.0 + numeric.amax()));
    let of_gradients = gradients
        .map(|(got, numeric)| (Vector3::from(got) - numeric).amax() / (1.0 + numeric.amax()));
    of_blocks
        .into_iter()
        .chain(of_gradients)
        .fold(0.0, f64::max)
}

/// 1e-8 of the largest entry: central differences at h = 1e-6 of residuals up to 10, rounded at 1e-16.
const DIFFERENCES: f64 = 1e-8;

fn pose() -> impl Strategy<Value = SE2> {
    (-3.0..3.0, -3.0..3.0, -3.2..3.2).prop_map(|(x, y, theta)| SE2::new(x, y, theta))
}

/// `A Aᵀ + I` of a random A: any correlation of the three entries.
fn information() -> impl Strategy<Value = Matrix3<f64>> {
    prop::array::uniform9(-6.0..6.0).prop_map(|entries| {
        let root = Matrix3::from_row_slice(&entries);
        root * root.transpose() + Matrix3::identity()
    })
}

/// A residual whose rotation stays away from π, where the log is discontinuous.
fn residual() -> impl Strategy<Value = Vector3<f64>> {
    (-2.0..2.0, -2.0..2.0, -2.6..2.6).prop_map(|(x, y, turn)| Vector3::new(x, y, turn))
}

proptest! {
    #[test]
    fn exact_blocks_agree_with_finite_differences_of_the_residual(
        from in pose(), to in pose(), residual in residual(), information in information(),
    ) {
        let measurement = from.between(&to) * SE2::exp(&residual).inverse();
        let factor = Between { from: 0, to: 1, measurement, information };
        let mismatch = mismatch(&factor, &from, &to, JacobianModel::Exact);
        prop_assert!(mismatch < DIFFERENCES, "{mismatch:e}");
    }

    #[test]
    fn chapter_blocks_agree_with_finite_differences_for_a_zero_residual(
        from in pose(), to in pose(), information in information(),
    ) {
        let factor = Between { from: 0, to: 1, measurement: from.between(&to), information };
        let mismatch = mismatch(&factor, &from, &to, JacobianModel::Chapter);
        prop_assert!(mismatch < DIFFERENCES, "{mismatch:e}");
    }
}

#[test]
fn chapter_blocks_differ_from_finite_differences_for_a_large_residual() {
    // Shows that the measure of the properties above distinguishes the two Jacobians.
    let (from, to, factor) = example();
    assert!(mismatch(&factor, &from, &to, JacobianModel::Exact) < DIFFERENCES);
    assert!(mismatch(&factor, &from, &to, JacobianModel::Chapter) > 0.1);
}

#[test]
fn chapter_blocks_use_the_adjoint_of_the_measurement() {
    let (from, to, factor) = example();
    let got = PreparedFactor::new(&factor).linearize(
        &PreparedPose::new(&from),
        &PreparedPose::new(&to),
        JacobianModel::Chapter,
        RobustKernel::None,
    );
    let jacobian_from = -factor.measurement.inverse().adjoint();
    let omega = factor.information;
    assert_eq!(symmetric(got.to_to), omega);
    let expected = omega * jacobian_from;
    assert!((Matrix3::from_column_slice(&got.to_from) - expected).amax() < 1e-12);
    let expected = jacobian_from.transpose() * omega * jacobian_from;
    assert!((symmetric(got.from_from) - expected).amax() < 1e-12);
}

#[test]
fn both_models_agree_for_a_zero_residual() {
    let (from, to, mut factor) = example();
    factor.measurement = from.between(&to);
    let prepared = PreparedFactor::new(&factor);
    let [chapter, exact] = [JacobianModel::Chapter, JacobianModel::Exact].map(|model| {
        prepared.linearize(
            &PreparedPose::new(&from),
            &PreparedPose::new(&to),
            model,
            RobustKernel::None,
        )
    });
    for (a, b) in chapter.to_from.iter().zip(exact.to_from) {
        assert!((a - b).abs() < 1e-12);
    }
}

#[test]
fn kernel_scales_blocks_and_gradient_but_not_the_norm() {
    let (from, to, factor) = example();
    let prepared = PreparedFactor::new(&factor);
    let (from, to) = (PreparedPose::new(&from), PreparedPose::new(&to));
    let plain = prepared.linearize(&from, &to, JacobianModel::Exact, RobustKernel::None);
    let kernel = RobustKernel::Huber { width: 1.0 };
    let robust = prepared.linearize(&from, &to, JacobianModel::Exact, kernel);
    let weight = kernel.weight(plain.squared_norm);
    assert!(weight < 1.0);
    assert_eq!(robust.squared_norm, plain.squared_norm);
    for (a, b) in robust.gradient_from.iter().zip(plain.gradient_from) {
        assert!((a - weight * b).abs() < 1e-10);
    }
}
