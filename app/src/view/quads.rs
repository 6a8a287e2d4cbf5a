//! Quads that a shader turns to the camera and draws round bodies on: one for each body, all in one
//! draw.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, MeshVertexBufferLayoutRef, PrimitiveTopology};
use bevy::prelude::*;
use bevy::render::render_resource::{RenderPipelineDescriptor, SpecializedMeshPipelineError};

/// A quad for each of the `bodies`; a vertex holds its corner (±1, ±1) and the body's index.
pub(super) fn quads(bodies: &[u32]) -> Mesh {
    let mut places = Vec::with_capacity(4 * bodies.len());
    let mut indices = Vec::with_capacity(6 * bodies.len());
    for (i, body) in (0_u32..).zip(bodies) {
        // Exact: below 2^24, more bodies than any buffer here holds.
        let index = *body as f32;
        places.extend([
            [-1.0, -1.0, index],
            [1.0, -1.0, index],
            [1.0, 1.0, index],
            [-1.0, 1.0, index],
        ]);
        indices.extend([0, 1, 2, 2, 3, 0].map(|corner| 4 * i + corner));
    }
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::RENDER_WORLD,
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, places)
    .with_inserted_indices(Indices::U32(indices))
}

/// Lets a pipeline draw [`quads`]: their places alone, from both sides.
///
/// # Errors
/// Where the mesh has no places.
pub(super) fn specialize(
    descriptor: &mut RenderPipelineDescriptor,
    layout: &MeshVertexBufferLayoutRef,
) -> Result<(), SpecializedMeshPipelineError> {
    let places = [Mesh::ATTRIBUTE_POSITION.at_shader_location(0)];
    descriptor.primitive.cull_mode = None;
    descriptor.vertex.buffers = vec![layout.0.get_layout(&places)?];
    Ok(())
}
