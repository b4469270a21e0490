//! The door `databases` of `tests/doors`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| slam2d_doors::databases::door(data));
