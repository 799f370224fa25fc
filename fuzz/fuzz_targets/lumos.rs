#![no_main]

lobe_fuzz::reader!(Lumos);
