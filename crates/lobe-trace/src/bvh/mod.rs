//! Trees of boxes, with 4 or 8 children per node.

mod binary;
mod collapse;
mod node;

pub(crate) use binary::Binary;
pub use node::WideBvh;
pub(crate) use node::{Child, Node};
