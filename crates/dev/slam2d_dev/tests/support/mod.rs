//! The program under test.

bench_support::program_under_test!(slam2d_dev, env!("CARGO_BIN_EXE_slam2d-dev"));
