use super::*;

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
fn log_curvature_meets_the_closed_form_where_the_series_ends() {
    let below = log_curvature(0.5 - 1e-14);
    let above = log_curvature(0.5 + 1e-14);
    // 2e-15: the closed form loses a few bits in 1 − x.
    assert!((below - above).abs() < 2e-15);
    assert_eq!(log_curvature(0.0), 1.0 / 12.0);
}

#[test]
fn exact_blocks_agree_with_finite_differences_of_the_residual() {
    let (from, to, factor) = example();
    let prepared = PreparedFactor::new(&factor);
    let residual =
        |from: &SE2, to: &SE2| prepared.residual(&PreparedPose::new(from), &PreparedPose::new(to));
    let h = 1e-6;
    let mut jacobian_from = Matrix3::zeros();
    let mut jacobian_to = Matrix3::zeros();
    for axis in 0..3 {
        let mut delta = Vector3::zeros();
        delta[axis] = h;
        jacobian_from.set_column(
            axis,
            &((residual(&from.boxplus(&delta), &to) - residual(&from.boxplus(&-delta), &to))
                / (2.0 * h)),
        );
        jacobian_to.set_column(
            axis,
            &((residual(&from, &to.boxplus(&delta)) - residual(&from, &to.boxplus(&-delta)))
                / (2.0 * h)),
        );
    }
    let omega = factor.information;
    let e = residual(&from, &to);
    let got = prepared.linearize(
        &PreparedPose::new(&from),
        &PreparedPose::new(&to),
        JacobianModel::Exact,
        RobustKernel::None,
    );
    // 1e-6: central differences of a function of order 1 at h = 1e-6, times Ω of order 100.
    let close = |a: Matrix3<f64>, b: Matrix3<f64>| assert!((a - b).amax() < 1e-6, "{a} {b}");
    close(
        symmetric(got.from_from),
        jacobian_from.transpose() * omega * jacobian_from,
    );
    close(
        Matrix3::from_column_slice(&got.to_from),
        jacobian_to.transpose() * omega * jacobian_from,
    );
    close(
        symmetric(got.to_to),
        jacobian_to.transpose() * omega * jacobian_to,
    );
    let gradient_from = jacobian_from.transpose() * omega * e;
    let gradient_to = jacobian_to.transpose() * omega * e;
    assert!((Vector3::from(got.gradient_from) - gradient_from).amax() < 1e-6);
    assert!((Vector3::from(got.gradient_to) - gradient_to).amax() < 1e-6);
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
fn both_models_agree_where_the_residual_vanishes() {
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
