//! The target `tables` of `tests/fuzz_targets`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| slam2d_fuzz_targets::tables::fuzz(data));
