//! Readers and writers against rules, damage and the answers of other programs.

mod channels;
mod golden_libbsdf;
mod hostile_binary;
mod hostile_text;
mod integra;
mod light_tools;
mod native;
mod own_tables;
mod pab;
mod polarised;
mod rgl;
mod rgl_lanes;
mod round_trip;
mod scattered_files;
mod speos_surface;
mod tables;
mod tracepro;
mod unknown;
mod window_xml;
mod window_xml_golden;
mod written_grids;
mod written_samples;
mod zemax;
