//! The program under test.

bench_support::program_under_test!(ch16_mark, env!("CARGO_BIN_EXE_ch16-mark"));
