//! Trees of boxes, 4 or 8 children a node.

mod binary;
mod collapse;
mod node;

pub(crate) use binary::Binary;
pub use node::WideBvh;
pub(crate) use node::{Child, Node};
