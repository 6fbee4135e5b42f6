#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| hypercircle_fuzz::msh::run(bytes));
