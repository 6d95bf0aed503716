#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| edgeline_fuzz::design(data));
