// Rounded polyhedra: triangles of many bodies, each corner in its body frame, the body's place in the buffer of grains.

#import bevy_pbr::mesh_view_bindings::view
#import grainfall::grain::{
    Grain, Shadow, Cut, Exit, ray_through, is_cut_away, is_sphere_cut_away, exit_from_cut, open_sky, skin, section,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<storage, read> grains: array<Grain>;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var<uniform> cut: Cut;
@group(#{MATERIAL_BIND_GROUP}) @binding(4) var<storage, read> shadows: array<Shadow>;
// Outward normal of each face and its distance from the origin, in the body frame and in radii of the sphere round the body.
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var<storage, read> planes: array<vec4<f32>>;
// First plane and number of planes of each grain.
@group(#{MATERIAL_BIND_GROUP}) @binding(3) var<storage, read> bodies: array<vec2<u32>>;

struct Corner {
    // In radii of the sphere round the body.
    @location(0) place: vec4<f32>,
    @location(1) normal: vec4<f32>,
    @location(2) grain: u32,
}

struct Covered {
    @builtin(position) position: vec4<f32>,
    @location(0) world: vec3<f32>,
    // Of length one on faces, shorter in between where the surface is round.
    @location(1) normal: vec3<f32>,
    // Colour; how much of the sky is open.
    @location(2) colour: vec4<f32>,
    @location(3) @interpolate(flat) grain: u32,
}

struct Painted {
    @location(0) colour: vec4<f32>,
#ifdef CUT
    @builtin(frag_depth) depth: f32,
#endif
}

fn turned(q: vec4<f32>, x: vec3<f32>) -> vec3<f32> {
    let t = 2.0 * cross(q.xyz, x);
    return x + q.w * t + cross(q.xyz, t);
}

fn turned_back(q: vec4<f32>, x: vec3<f32>) -> vec3<f32> {
    return turned(vec4<f32>(-q.xyz, q.w), x);
}

@vertex
fn vertex(corner: Corner) -> Covered {
    let grain = grains[corner.grain];
    let normal = turned(grain.orientation, normalize(corner.normal.xyz));
    var covered: Covered;
    covered.world = grain.centre + grain.radius * turned(grain.orientation, corner.place.xyz);
    covered.normal = normal;
    covered.colour = vec4<f32>(grain.colour, open_sky(shadows[corner.grain], normal));
    covered.grain = corner.grain;
    covered.position = view.clip_from_world * vec4<f32>(covered.world, 1.0);
#ifdef CUT
    if is_sphere_cut_away(cut, grain.centre, grain.radius) {
        // All corners in one place: nothing is drawn.
        covered.position = vec4<f32>(0.0, 0.0, 0.0, 1.0);
    }
#endif
    return covered;
}

fn surface(covered: Covered) -> vec3<f32> {
    let to_eye = -ray_through(covered.world).direction;
    let normal = normalize(covered.normal);
    // Dust settles on edges: a face is outlined softly.
    let edge = smoothstep(0.0, 0.3, 1.0 - dot(covered.normal, covered.normal));
    return skin(covered.colour.rgb * mix(1.0, 0.72, edge), covered.colour.a, normal, to_eye, 0.0);
}

#ifdef CUT

// How far inside the body the point `x` is, along the plane of this normal; negative outside.
fn from_rim(body: u32, x: vec3<f32>, normal: vec3<f32>) -> f32 {
    let grain = grains[body];
    let place = turned_back(grain.orientation, x - grain.centre);
    let along = turned_back(grain.orientation, normal);
    var least = grain.radius - length(place);
    for (var i = 0u; i < bodies[body].y; i++) {
        let plane = planes[bodies[body].x + i];
        let lean = dot(plane.xyz, along);
        least = min(least, (plane.w * grain.radius - dot(plane.xyz, place)) * inverseSqrt(max(1.0 - lean * lean, 1e-4)));
    }
    return least;
}

@fragment
fn fragment(covered: Covered, @builtin(front_facing) front: bool) -> Painted {
    let here = is_cut_away(cut, covered.world);
    if front {
        if here { discard; }
        return Painted(vec4<f32>(surface(covered), 1.0), covered.position.z);
    }
    // The far side of a body. What is seen of it is the section where the ray leaves what is cut away, if it does so
    // within the body.
    if here { discard; }
    let ray = ray_through(covered.world);
    let exit = exit_from_cut(cut, ray);
    let hit = ray.origin + exit.t * ray.direction;
    if exit.t > dot(covered.world - ray.origin, ray.direction) { discard; }
    let inside = from_rim(covered.grain, hit, exit.plane.xyz);
    if inside < 0.0 { discard; }
    let clip = view.clip_from_world * vec4<f32>(hit, 1.0);
    let radius = grains[covered.grain].radius;
    let light = section(covered.colour.rgb, cut, exit.plane, hit, inside, 0.07 * radius);
    return Painted(vec4<f32>(light, 1.0), clip.z / clip.w);
}

#else

@fragment
fn fragment(covered: Covered) -> Painted {
    return Painted(vec4<f32>(surface(covered), 1.0));
}

#endif
