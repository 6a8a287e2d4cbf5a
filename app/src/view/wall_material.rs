//! What walls are painted with: a pane with a pattern of lines.
//!
//! In: colours, a pattern. Out: a material for Bevy, whose shader is `container.wgsl`.

use bevy::asset::uuid_handle;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
};
use bevy::shader::ShaderRef;

pub(super) const SHADER: Handle<Shader> = uuid_handle!("f1b2a8a4-5d51-4a1e-8a2a-0d6ad0c3d0b2");

/// The lines on a piece and what its `uv` means: a definition of the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub(super) enum Pattern {
    Plain,
    Plate,
    Rim,
    Grid,
    Hoop,
    Rings,
}

impl Pattern {
    fn definition(self) -> Option<&'static str> {
        match self {
            Self::Plain => None,
            Self::Plate => Some("PLATE"),
            Self::Rim => Some("RIM"),
            Self::Grid => Some("GRID"),
            Self::Hoop => Some("HOOP"),
            Self::Rings => Some("RINGS"),
        }
    }
}

/// Cells from the middle to where what never fades has faded away.
pub(super) const NEVER_FADED: f32 = 1e30;

/// The material of a wall.
#[derive(Asset, TypePath, AsBindGroup, Clone)]
#[bind_group_data(WallKey)]
pub(super) struct WallMaterial {
    #[uniform(0)]
    pub(super) look: WallLook,
    pub(super) alpha_mode: AlphaMode,
    pub(super) pattern: Pattern,
    pub(super) both_sides: bool,
}

/// Colours of a wall as its shader reads them, linear with alpha.
#[derive(Clone, Copy, PartialEq, ShaderType)]
pub(super) struct WallLook {
    pub(super) surface: Vec4,
    pub(super) line: Vec4,
    pub(super) mark: Vec4,
    /// Cells from the middle to where it has faded away.
    pub(super) fade: f32,
    /// Radius of the circle that is marked, in cells.
    pub(super) circle: f32,
    pub(super) unused: Vec2,
}

/// What of a piece is part of the pipeline's key: its lines, and whether it is drawn from both
/// sides.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
#[repr(C)]
pub(super) struct WallKey {
    pattern: Pattern,
    both_sides: bool,
}

impl From<&WallMaterial> for WallKey {
    fn from(material: &WallMaterial) -> Self {
        Self {
            pattern: material.pattern,
            both_sides: material.both_sides,
        }
    }
}

impl Material for WallMaterial {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn alpha_mode(&self) -> AlphaMode {
        self.alpha_mode
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    fn specialize(
        _pipeline: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _layout: &MeshVertexBufferLayoutRef,
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let WallKey {
            pattern,
            both_sides,
        } = key.bind_group_data;
        if both_sides {
            descriptor.primitive.cull_mode = None;
        }
        if let (Some(fragment), Some(pattern)) = (&mut descriptor.fragment, pattern.definition()) {
            fragment.shader_defs.push(pattern.into());
        }
        Ok(())
    }
}
