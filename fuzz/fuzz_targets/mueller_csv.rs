#![no_main]

lobe_fuzz::reader!(MuellerCsv);
