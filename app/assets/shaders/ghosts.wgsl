// Ghosts of grains that are drawn smaller than they are: what they are at full size, as a rim of light or of shade. What they
// add to a picture, or take from it, is the same in whatever order they are drawn.

#import bevy_pbr::mesh_view_bindings::view
#import grainfall::grain::{Grain, Cut, orthographic, ray_through, is_cut_away}

struct Look {
    // Full size over the size in the buffer of grains.
    size: f32,
    // How strong a rim is.
    strength: f32,
    // 1 where ghosts take light away, on a light background; else 0.
    darkens: f32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<storage, read> grains: array<Grain>;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var<uniform> cut: Cut;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var<uniform> look: Look;

struct Covered {
    @builtin(position) position: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) @interpolate(flat) colour: vec3<f32>,
#ifdef FACETS
    // Of length one on faces, shorter in between where the surface is round.
    @location(2) normal: vec3<f32>,
#else
    // The outline is the unit circle.
    @location(2) across: vec2<f32>,
    // A pixel in radii of the outline.
    @location(3) @interpolate(flat) pixel: f32,
#endif
}

// Where the point `x` [m] is in the picture, as deep as what lies so far behind it: what is in a grain is not seen through its
// own ghost, and keeps its colour.
fn seen_behind(x: vec3<f32>, depth: f32) -> vec4<f32> {
    var place = view.clip_from_world * vec4<f32>(x, 1.0);
    let behind = view.clip_from_world * vec4<f32>(x + depth * ray_through(x).direction, 1.0);
    place.z = behind.z / behind.w * place.w;
    return place;
}

// The light that a ghost of this colour adds, or the share of light that it leaves, where its rim is so strong.
fn ghost(colour: vec3<f32>, rim: f32) -> vec4<f32> {
    let share = clamp(look.strength * rim, 0.0, 1.0);
    let added = vec4<f32>(share * mix(colour, vec3<f32>(1.0), 0.35), 0.0);
    let left = vec4<f32>(mix(vec3<f32>(1.0), 0.4 * colour, share), 1.0);
    return select(added, left, look.darkens > 0.5);
}

#ifdef FACETS

struct Corner {
    // In radii of the sphere round the body.
    @location(0) place: vec4<f32>,
    @location(1) normal: vec4<f32>,
    @location(2) grain: u32,
}

fn turned(q: vec4<f32>, x: vec3<f32>) -> vec3<f32> {
    let t = 2.0 * cross(q.xyz, x);
    return x + q.w * t + cross(q.xyz, t);
}

@vertex
fn vertex(corner: Corner) -> Covered {
    let grain = grains[corner.grain];
    var covered: Covered;
    covered.world = grain.centre + look.size * grain.radius * turned(grain.orientation, corner.place.xyz);
    covered.normal = turned(grain.orientation, normalize(corner.normal.xyz));
    covered.colour = grain.colour;
    covered.position = seen_behind(covered.world, 2.0 * look.size * grain.radius);
    return covered;
}

@fragment
fn fragment(covered: Covered) -> @location(0) vec4<f32> {
    if is_cut_away(cut, covered.world) { discard; }
    let edge = smoothstep(0.0, 0.25, 1.0 - dot(covered.normal, covered.normal));
    return ghost(covered.colour, mix(0.12, 1.0, edge));
}

#else

struct Corner {
    // x, y: which corner, ±1; z: index of the grain.
    @location(0) place: vec3<f32>,
}

@vertex
fn vertex(corner: Corner) -> Covered {
    let grain = grains[u32(corner.place.z + 0.5)];
    let radius = look.size * grain.radius;
    // Selected, not branched to, as in `ray_through`.
    let parallel = orthographic();
    let forward = ray_through(grain.centre).direction;
    let distance = select(length(grain.centre - view.world_position), 1.0, parallel);
    let tangent = distance * distance - radius * radius;
    let seen = select(0.0, radius * distance * inverseSqrt(tangent), tangent > 0.0);
    let outline = select(seen, radius, parallel);
    let pixel = 2.0 * distance / (view.clip_from_view[1][1] * view.viewport.w);
    var covered: Covered;
    covered.pixel = select(1.0, pixel / outline, outline > 0.0);
    covered.across = corner.place.xy * (1.0 + covered.pixel);
    let side = normalize(cross(forward, view.world_from_view[1].xyz));
    let upward = cross(side, forward);
    covered.world = grain.centre + outline * (covered.across.x * side + covered.across.y * upward);
    covered.colour = grain.colour;
    covered.position = seen_behind(covered.world, radius);
    return covered;
}

@fragment
fn fragment(covered: Covered) -> @location(0) vec4<f32> {
    let from_middle = length(covered.across);
    let coverage = clamp(0.5 + (1.0 - from_middle) / covered.pixel, 0.0, 1.0);
    if coverage <= 0.0 || is_cut_away(cut, covered.world) { discard; }
    let square = min(from_middle * from_middle, 1.0);
    // Thin where one looks straight through its skin, a rim where the skin is seen from the side.
    let rim = mix(0.015, 1.0, square * square * square * square);
    return ghost(covered.colour, coverage * rim);
}

#endif
