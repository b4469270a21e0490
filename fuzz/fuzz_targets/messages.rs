//! The door `messages` of `tests/doors`.

#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| slam2d_doors::messages::door(data));
