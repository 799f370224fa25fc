//! Figures of measured materials, for goniometer engineers and shading artists.
//!
//! [`Subject`] is an opened file together with the directions at which it was measured; a [`View`] says what to show,
//! and [`Shown`] combines both. [`draw`] makes one figure of one or more of these as SVG, [`rasterise`] turns that into
//! a PNG, and [`page()`] is a self-contained HTML page of all figures. A figure is a pure function of files and views:
//! no clock, no random numbers.
//!
//! Conventions of every figure: the light comes from the left; viewing angles are positive on the side of the mirror
//! direction (for transmission: of the straight-through ray); `f` is in 1/sr, without the cosine.
#![forbid(unsafe_code)]

mod albedo;
mod ball;
mod evaluate;
mod figures;
mod geometry;
mod image;
mod in_plane;
mod ink;
mod layout;
mod measured;
mod page;
mod polarised;
mod quantity;
#[cfg(feature = "raster")]
mod raster;
mod residual;
mod scale;
mod shade;
mod shown;
mod simplify;
mod slice;
mod spectra;
mod subject;
mod svg;
mod tables;
mod view;

pub use albedo::{Albedo, albedos};
pub use ball::Ball;
pub use evaluate::{Progress, Silent};
pub use figures::{DrawError, Drawing, Figure, Picture, draw, draw_picture};
pub use geometry::{from_disk, in_plane, incident, to_disk};
pub use image::Image;
pub use in_plane::{Curve, curves};
pub use page::{Page, page, page_of_picture, page_with_fit};
pub use quantity::Quantity;
#[cfg(feature = "raster")]
pub use raster::{RasterError, rasterise};
pub use residual::{Fitted, Values};
pub use scale::{Scale, Scaling};
pub use shade::{Sphere, Studio, shade};
pub use shown::Shown;
pub use slice::{Slice, slice};
pub use spectra::{Spectrum, spectra};
pub use subject::Subject;
pub use tables::Facts;
pub use view::{View, ViewError};
