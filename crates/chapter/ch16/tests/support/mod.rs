//! The program under test.

bench_support::program_under_test!(ch16, env!("CARGO_BIN_EXE_ch16"));
