//! Every representation in lanes against its `f64` reference.

mod budget;
mod histograms;
mod interpolation;
mod lanes_against_reference;
mod outside;
mod patches;
mod reference;
mod representations;
mod rgl_lanes;
mod sampling;
mod spherical;
