// Links between points: round bars that get thicker or thinner towards their end, or have a waist, as bands that face
// the viewer.

#import bevy_pbr::mesh_view_bindings::view
#import grainfall::grain::ray_through
#import grainfall::light::{matt_light, gloss}

struct Link {
    from_point: vec3<f32>,
    // The larger of the radii at both ends.
    radius: f32,
    to_point: vec3<f32>,
    // Bytes: the radius at each end in 255ths of the larger one; the place in the palette in two bits with that among the
    // forces in six; how much thinner the middle is.
    shape: u32,
}

struct Palette {
    // The fourth number tells how it shines.
    colours: array<vec4<f32>, 4>,
    // Of the first two kinds, by how large the force is.
    forces: array<vec4<f32>, 64>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<storage, read> links: array<Link>;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var<uniform> palette: Palette;

struct Corner {
    // x, y: which corner, ±1; z: index of the link.
    @location(0) place: vec3<f32>,
}

struct Covered {
    @builtin(position) position: vec4<f32>,
    @location(0) world: vec3<f32>,
    // From one edge of the band (−1) to the other (1).
    @location(1) across: f32,
    @location(2) side: vec3<f32>,
    @location(3) @interpolate(flat) colour: vec4<f32>,
    // From one end (−1) to the other (1).
    @location(4) along: f32,
    @location(5) @interpolate(flat) waist: f32,
}

@vertex
fn vertex(corner: Corner) -> Covered {
    let link = links[u32(corner.place.z + 0.5)];
    let along = link.to_point - link.from_point;
    let end = 0.5 + 0.5 * corner.place.y;
    let middle = mix(link.from_point, link.to_point, end);
    let to_eye = -ray_through(middle).direction;
    let sideways = cross(along, to_eye);
    var covered: Covered;
    // A link that is seen from its end, or has no length, shows nothing.
    covered.side = sideways * inverseSqrt(max(dot(sideways, sideways), 1e-30));
    covered.across = corner.place.x;
    let unpacked = unpack4x8unorm(link.shape);
    let shares = unpacked.xy;
    covered.along = corner.place.y;
    covered.waist = unpacked.w;
    covered.world = middle + corner.place.x * link.radius * mix(shares.x, shares.y, end) * covered.side;
    let kind = (link.shape >> 16u) & 3u;
    let force = palette.forces[(link.shape >> 18u) & 63u];
    covered.colour = select(palette.colours[kind], force, kind < 2u);
    covered.position = view.clip_from_world * vec4<f32>(covered.world, 1.0);
    return covered;
}

@fragment
fn fragment(covered: Covered) -> @location(0) vec4<f32> {
    let across = covered.across / (1.0 - covered.waist * (1.0 - covered.along * covered.along));
    if abs(across) > 1.0 { discard; }
    let to_eye = -ray_through(covered.world).direction;
    let upward = sqrt(max(1.0 - across * across, 0.0));
    let normal = normalize(across * covered.side + upward * to_eye);
    let light = covered.colour.rgb * matt_light(normal) * mix(0.6, 1.0, upward)
        + vec3<f32>(covered.colour.a * gloss(normal, to_eye));
    return vec4<f32>(light, 1.0);
}
