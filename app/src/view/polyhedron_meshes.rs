//! Polyhedra: their surfaces as triangles, a few draws for all of them.
//!
//! In: the buffer of grains and the shapes of those that are no spheres. Out: meshes of some
//! thousand grains each, made once for a scene, some a frame, so that no frame waits for all of
//! them. A corner holds its place in the body frame and the grain's index; the shader finds where
//! the body is in the buffer. Where something is cut away the shader meets each body's section with
//! the planes of its faces. Two runs side by side have the same shapes, so both halves share the
//! meshes.

use crate::simulation::DrawnIn;
use crate::view::facets::Facets;
use crate::view::grain_buffer::{CutPlanes, Forms, GrainBuffer, polyhedron};
use crate::view::shown_worlds::{ShownWorlds, ViewSystems, layers};
use crate::view::view_settings::ViewSettings;
use bevy::asset::{RenderAssetUsages, load_internal_asset, uuid_handle};
use bevy::camera::visibility::NoFrustumCulling;
use bevy::mesh::{
    Indices, MeshVertexAttribute, MeshVertexBufferLayoutRef, PrimitiveTopology,
    VertexAttributeValues, VertexBufferLayout, VertexFormat,
};
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, SpecializedMeshPipelineError,
};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::ShaderRef;
use bytemuck::{Pod, Zeroable};
use grainfall::lab::Half;
use grainfall::world::{Polyhedra, Polyhedron};
use std::time::{Duration, Instant};

const SHADER: Handle<Shader> = uuid_handle!("a5a3c7f0-7a3d-4b1f-8d0c-0f6c5b8e9d33");
/// Grains in one mesh.
const CHUNK: usize = 2048;
/// Time in a frame after which no further mesh is begun.
const PATIENCE: Duration = Duration::from_millis(6);
/// Place in the body frame over the radius of the sphere round the body.
const PLACE: MeshVertexAttribute =
    MeshVertexAttribute::new("Place", 0x6772_0001, VertexFormat::Snorm16x4);

const NORMAL: MeshVertexAttribute =
    MeshVertexAttribute::new("BodyNormal", 0x6772_0002, VertexFormat::Snorm8x4);

const GRAIN: MeshVertexAttribute =
    MeshVertexAttribute::new("Grain", 0x6772_0003, VertexFormat::Uint32);

/// Adds the polyhedra's material and what keeps their meshes up to date.
pub(super) fn plugin(app: &mut App) {
    load_internal_asset!(
        app,
        SHADER,
        "../../assets/shaders/polyhedra.wgsl",
        Shader::from_wgsl
    );
    app.add_plugins(MaterialPlugin::<PolyhedronMaterial>::default())
        .init_resource::<Meshing>()
        .add_systems(
            Update,
            (start_over, mesh_some, update)
                .chain()
                .in_set(ViewSystems::Draw),
        );
}

#[derive(Asset, TypePath, AsBindGroup, Clone)]
#[bind_group_data(IsCut)]
struct PolyhedronMaterial {
    #[storage(0, read_only)]
    grains: Handle<ShaderBuffer>,
    #[uniform(1)]
    cut: CutPlanes,
    /// The planes of all faces.
    #[storage(2, read_only)]
    planes: Handle<ShaderBuffer>,
    /// Where each grain's planes are among them.
    #[storage(3, read_only)]
    bodies: Handle<ShaderBuffer>,
    #[storage(4, read_only)]
    shadows: Handle<ShaderBuffer>,
}

/// Whether anything is cut away: part of the pipeline's key, because only then sections and depths
/// are computed.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
#[repr(C)]
struct IsCut(bool);

impl From<&PolyhedronMaterial> for IsCut {
    fn from(material: &PolyhedronMaterial) -> Self {
        Self(material.cut != CutPlanes::default())
    }
}

impl Material for PolyhedronMaterial {
    fn vertex_shader() -> ShaderRef {
        SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        SHADER.into()
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
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        descriptor.vertex.buffers = vec![facet_layout(layout)?];
        if key.bind_group_data.0 {
            // A far side shows the section before it.
            descriptor.primitive.cull_mode = None;
            descriptor.vertex.shader_defs.push("CUT".into());
            if let Some(fragment) = &mut descriptor.fragment {
                fragment.shader_defs.push("CUT".into());
            }
        }
        Ok(())
    }
}

/// How the corners of the meshes lie in memory.
///
/// # Errors
/// Where the mesh is none of these.
pub(super) fn facet_layout(
    layout: &MeshVertexBufferLayoutRef,
) -> Result<VertexBufferLayout, SpecializedMeshPipelineError> {
    Ok(layout.0.get_layout(&[
        PLACE.at_shader_location(0),
        NORMAL.at_shader_location(1),
        GRAIN.at_shader_location(2),
    ])?)
}

/// Where the planes of a grain's faces are, as the shader reads it.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct PlaneRange {
    first: u32,
    count: u32,
}

/// One of the meshes in one half of the picture.
#[derive(Component)]
pub(super) struct Chunk;

/// How far the meshes of polyhedra are.
#[derive(Resource, Default)]
pub struct Meshing {
    /// What they are made of.
    forms: Forms,
    /// Grains to mesh: none where all are spheres.
    count: usize,
    /// Grains before this one have their mesh, and their planes are in `planes`.
    next: usize,
    planes: Vec<Vec4>,
    bodies: Vec<PlaneRange>,
    /// One for each half of the picture.
    materials: [Handle<PolyhedronMaterial>; 2],
}

impl Meshing {
    /// Whether all meshes of the world shown are there.
    pub fn is_whole(&self) -> bool {
        self.next >= self.count
    }

    /// The mesh of the next grains; none where all of them are spheres.
    fn next_chunk(&mut self, polyhedra: &Polyhedra) -> Option<Mesh> {
        let end = (self.next + CHUNK).min(self.count);
        let mut surfaces = FacetMeshes::default();
        for i in self.next..end {
            let first = self.planes.len() as u32;
            if let Some(shape) = polyhedron(Some(polyhedra), i) {
                let facets = Facets::of(shape);
                surfaces.add(i, shape, &facets);
                let radius = shape.bounding_radius() as f32;
                let scaled = |plane: &Vec4| plane.truncate().extend(plane.w / radius);
                self.planes.extend(facets.planes.iter().map(scaled));
            }
            let count = self.planes.len() as u32 - first;
            self.bodies.push(PlaneRange { first, count });
        }
        self.next = end;
        surfaces.mesh()
    }
}

/// Takes the meshes away where the shapes are others, and begins anew.
fn start_over(
    mut commands: Commands,
    shown: Res<ShownWorlds>,
    grains: Res<GrainBuffer>,
    mut meshing: ResMut<Meshing>,
    chunks: Query<Entity, With<Chunk>>,
    mut materials: ResMut<Assets<PolyhedronMaterial>>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
) {
    if !shown.is_changed() {
        return;
    }
    let renewed = match shown.world() {
        Some(world) => meshing.forms.renew(world),
        None => true,
    };
    if !renewed {
        return;
    }
    for chunk in &chunks {
        commands.entity(chunk).despawn();
    }
    let forms = std::mem::take(&mut meshing.forms);
    *meshing = Meshing::default();
    if let Some(world) = shown.world() {
        meshing.forms = forms;
        if world.polyhedra.is_some() {
            meshing.count = world.grains.len();
            let planes = buffers.add(buffer(&[Vec4::ZERO]));
            let bodies = buffers.add(buffer(&[PlaneRange::zeroed()]));
            meshing.materials = Half::ALL.map(|half| {
                materials.add(PolyhedronMaterial {
                    grains: grains.handles(half).grains.clone(),
                    shadows: grains.handles(half).shadows.clone(),
                    cut: CutPlanes::default(),
                    planes: planes.clone(),
                    bodies: bodies.clone(),
                })
            });
        }
    }
}

fn buffer<T: Pod>(entries: &[T]) -> ShaderBuffer {
    ShaderBuffer::new(
        bytemuck::cast_slice(entries),
        RenderAssetUsages::RENDER_WORLD,
    )
}

/// Makes the next meshes; after the last one the shader gets the planes.
fn mesh_some(
    mut commands: Commands,
    shown: Res<ShownWorlds>,
    mut meshing: ResMut<Meshing>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<PolyhedronMaterial>>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
) {
    let Some(polyhedra) = shown.world().and_then(|world| world.polyhedra.as_deref()) else {
        return;
    };
    if meshing.is_whole() {
        return;
    }
    let began = Instant::now();
    while !meshing.is_whole() && began.elapsed() < PATIENCE {
        if let Some(mesh) = meshing.next_chunk(polyhedra) {
            let mesh = meshes.add(mesh);
            commands.spawn_batch(Half::ALL.map(|half| {
                (
                    Chunk,
                    DrawnIn(half),
                    layers(half),
                    Mesh3d(mesh.clone()),
                    MeshMaterial3d(meshing.materials[half.index()].clone()),
                    NoFrustumCulling,
                )
            }));
        }
    }
    if meshing.is_whole() && !meshing.planes.is_empty() {
        let planes = buffers.add(buffer(&std::mem::take(&mut meshing.planes)));
        let bodies = buffers.add(buffer(&std::mem::take(&mut meshing.bodies)));
        for material in &meshing.materials {
            if let Some(mut material) = materials.get_mut(material) {
                material.planes = planes.clone();
                material.bodies = bodies.clone();
            }
        }
    }
}

/// Draws from the present buffers, cut as asked.
fn update(
    settings: Res<ViewSettings>,
    grains: Res<GrainBuffer>,
    meshing: Res<Meshing>,
    mut materials: ResMut<Assets<PolyhedronMaterial>>,
) {
    let cut = CutPlanes::of(settings.cut);
    for half in Half::ALL {
        let (material, own) = (&meshing.materials[half.index()], grains.handles(half));
        let stale =
            |material: &PolyhedronMaterial| material.cut != cut || material.grains != own.grains;
        if materials.get(material).is_some_and(stale)
            && let Some(mut material) = materials.get_mut(material)
        {
            material.cut = cut;
            material.grains = own.grains.clone();
            material.shadows = own.shadows.clone();
        }
    }
}

/// The surfaces of some grains as one mesh.
#[derive(Default)]
struct FacetMeshes {
    places: Vec<[i16; 4]>,
    normals: Vec<[i8; 4]>,
    grains: Vec<u32>,
    indices: Vec<u32>,
}

impl FacetMeshes {
    fn add(&mut self, grain: usize, shape: &Polyhedron, facets: &Facets) {
        let scale = f32::from(i16::MAX) / shape.bounding_radius() as f32;
        let first = self.places.len() as u32;
        for (place, normal) in &facets.corners {
            let [x, y, z] = (*place * scale).to_array().map(|x| x.round() as i16);
            self.places.push([x, y, z, 0]);
            let normal = *normal * f32::from(i8::MAX);
            let [x, y, z] = normal.to_array().map(|x| x.round() as i8);
            self.normals.push([x, y, z, 0]);
            self.grains.push(grain as u32);
        }
        let corners = facets.triangles.iter().flatten();
        self.indices.extend(corners.map(|corner| first + corner));
    }

    /// The mesh; none where nothing was added.
    fn mesh(self) -> Option<Mesh> {
        (!self.indices.is_empty()).then(|| {
            Mesh::new(
                PrimitiveTopology::TriangleList,
                RenderAssetUsages::RENDER_WORLD,
            )
            .with_inserted_attribute(PLACE, VertexAttributeValues::Snorm16x4(self.places))
            .with_inserted_attribute(NORMAL, VertexAttributeValues::Snorm8x4(self.normals))
            .with_inserted_attribute(GRAIN, VertexAttributeValues::Uint32(self.grains))
            .with_inserted_indices(Indices::U32(self.indices))
        })
    }
}
