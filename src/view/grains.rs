//! The grains: one draw for all of them, exact spheres.
//!
//! In: the world shown and how to colour it. Out: one entity whose mesh is a quad per grain; the shader finds centre,
//! radius and colour in a buffer that is rewritten when the world or the colours change, and raymarches the sphere. So
//! nothing is done per grain on the processor but filling that buffer. What is cut away is decided in the shader too.

use super::occlusion::occlusions;
use super::{ColourBy, ColourMap, ColourRange, Cut, Shown, ViewSettings, colour};
use crate::world::World;
use bevy::asset::{RenderAssetUsages, load_internal_asset, uuid_handle};
use bevy::camera::visibility::NoFrustumCulling;
use bevy::mesh::{Indices, MeshVertexBufferLayoutRef, PrimitiveTopology};
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::ShaderRef;
use bytemuck::{Pod, Zeroable};

const SHADER: Handle<Shader> = uuid_handle!("6d0f7a0e-64c1-4a53-9c2e-2f6f0a4b5c11");

/// Adds the grains' material, their entity and what keeps it up to date.
pub(super) fn plugin(app: &mut App) {
    load_internal_asset!(
        app,
        SHADER,
        "../../assets/shaders/grains.wgsl",
        Shader::from_wgsl
    );
    app.add_plugins(MaterialPlugin::<GrainMaterial>::default())
        .add_systems(Startup, spawn)
        .add_systems(
            Update,
            (colour_and_place, cut).in_set(super::ViewSystems::Draw),
        );
}

/// A grain as the shader reads it.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct DrawnGrain {
    centre: [f32; 3],
    radius: f32,
    colour: [f32; 3],
    /// [`Occlusion`], in its order.
    hidden_mean: f32,
    hidden_gradient: [f32; 3],
    hidden_quadrupole: [f32; 5],
}

#[derive(Asset, TypePath, AsBindGroup, Clone)]
struct GrainMaterial {
    #[storage(0, read_only)]
    grains: Handle<ShaderBuffer>,
    #[uniform(1)]
    picture: Picture,
}

/// What all grains have in common, as the shader reads it.
#[derive(Clone, Copy, Default, PartialEq, ShaderType)]
struct Picture {
    cut_normal: Vec3,
    cut_offset: f32,
}

impl Picture {
    fn of(cut: Option<Cut>) -> Self {
        cut.map_or_else(Self::default, |Cut { axis, position }| Self {
            cut_normal: axis.unit().as_vec3(),
            cut_offset: position as f32,
        })
    }
}

impl Material for GrainMaterial {
    fn vertex_shader() -> ShaderRef {
        SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn alpha_mode(&self) -> AlphaMode {
        AlphaMode::AlphaToCoverage
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
        layout: &MeshVertexBufferLayoutRef,
        _key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        descriptor.primitive.cull_mode = None;
        descriptor.vertex.buffers = vec![
            layout
                .0
                .get_layout(&[Mesh::ATTRIBUTE_POSITION.at_shader_location(0)])?,
        ];
        Ok(())
    }
}

/// The entity that draws all grains.
#[derive(Component)]
struct DrawnGrains {
    count: usize,
}

fn spawn(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<GrainMaterial>>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
) {
    let material = GrainMaterial {
        grains: buffers.add(buffer(&[DrawnGrain::zeroed()])),
        picture: Picture::default(),
    };
    commands.spawn((
        DrawnGrains { count: 1 },
        Mesh3d(meshes.add(quads(1))),
        MeshMaterial3d(materials.add(material)),
        NoFrustumCulling,
    ));
}

/// What decides the grains' colours and shadows beside the world.
type Colouring = (ColourBy, ColourMap, ColourRange, Option<Cut>);

/// Rewrites the buffer when the world or the colouring is another.
fn colour_and_place(
    shown: Res<Shown>,
    mut settings: ResMut<ViewSettings>,
    mut last: Local<Option<Colouring>>,
    drawn: Single<(
        &mut DrawnGrains,
        &mut Mesh3d,
        &MeshMaterial3d<GrainMaterial>,
    )>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<GrainMaterial>>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
) {
    let colouring = (
        settings.colour_by,
        settings.colour_map,
        settings.range,
        settings.cut,
    );
    if !shown.is_changed() && *last == Some(colouring) {
        return;
    }
    *last = Some(colouring);
    let (mut drawn, mut mesh, material) = drawn.into_inner();
    let world = shown.world();
    settings.legend = world.and_then(|world| {
        let before = settings.legend.as_ref();
        colour::legend(world, settings.colour_by, settings.range, before)
    });
    let grains = world.map_or_else(Vec::new, |world| drawn_grains(world, &settings));
    // A buffer cannot be empty: where there is no grain, one of no size is drawn.
    let grains = if grains.is_empty() {
        vec![DrawnGrain::zeroed()]
    } else {
        grains
    };
    let Some(mut material) = materials.get_mut(&material.0) else {
        return;
    };
    if grains.len() == drawn.count {
        if let Some(mut buffer) = buffers.get_mut(&material.grains) {
            buffer.data = Some(bytemuck::cast_slice(&grains).to_vec());
        }
    } else {
        drawn.count = grains.len();
        mesh.0 = meshes.add(quads(grains.len()));
        material.grains = buffers.add(buffer(&grains));
    }
}

/// A buffer that holds `grains`.
fn buffer(grains: &[DrawnGrain]) -> ShaderBuffer {
    ShaderBuffer::new(
        bytemuck::cast_slice(grains),
        RenderAssetUsages::RENDER_WORLD,
    )
}

fn drawn_grains(world: &World, settings: &ViewSettings) -> Vec<DrawnGrain> {
    let grains = &world.grains;
    let spheres: Vec<(Vec3, f32)> = (0..grains.len())
        .map(|i| (grains.position[i].as_vec3(), grains.radius[i] as f32))
        .collect();
    let picture = Picture::of(settings.cut);
    let hidden = occlusions(&spheres, |x| picture.cut_normal.dot(x) > picture.cut_offset);
    let mut drawn = Vec::with_capacity(grains.len());
    colour::colours(
        world,
        settings.colour_by,
        settings.colour_map,
        settings.legend.as_ref(),
        |colour| {
            let i = drawn.len();
            let hidden = hidden[i];
            drawn.push(DrawnGrain {
                centre: spheres[i].0.to_array(),
                radius: spheres[i].1,
                colour,
                hidden_mean: hidden.mean,
                hidden_gradient: hidden.gradient.to_array(),
                hidden_quadrupole: hidden.quadrupole,
            });
        },
    );
    drawn
}

/// Tells the shader where the cut is.
fn cut(
    settings: Res<ViewSettings>,
    drawn: Single<&MeshMaterial3d<GrainMaterial>, With<DrawnGrains>>,
    mut materials: ResMut<Assets<GrainMaterial>>,
) {
    let picture = Picture::of(settings.cut);
    let handle = &drawn.0;
    if materials
        .get(handle)
        .is_some_and(|material| material.picture != picture)
        && let Some(mut material) = materials.get_mut(handle)
    {
        material.picture = picture;
    }
}

/// A quad for each of `count` grains; a vertex holds its corner (±1, ±1) and the grain's index.
fn quads(count: usize) -> Mesh {
    let mut places = Vec::with_capacity(4 * count);
    let mut indices = Vec::with_capacity(6 * count);
    for i in 0..count as u32 {
        // Exact: below 2^24, more grains than any buffer here holds.
        let index = i as f32;
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
