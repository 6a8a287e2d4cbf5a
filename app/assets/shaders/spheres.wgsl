// Spheres, each raymarched on a quad that just covers its outline: exact outline, depth and section at every size.

#import bevy_pbr::mesh_view_bindings::view
#import grainfall::grain::{
    Grain, Shadow, Cut, orthographic, ray_through, is_cut_away, is_sphere_cut_away, exit_from_cut, open_sky, skin, section, pattern,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<storage, read> grains: array<Grain>;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var<uniform> cut: Cut;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var<storage, read> shadows: array<Shadow>;

struct Corner {
    // x, y: which corner, ±1; z: index of the grain.
    @location(0) place: vec3<f32>,
}

struct Covered {
    @builtin(position) position: vec4<f32>,
    @location(0) world: vec3<f32>,
    // The outline is the unit circle.
    @location(1) across: vec2<f32>,
    // A pixel in radii of the outline.
    @location(2) @interpolate(flat) pixel: f32,
    // The grain, handed over because software drivers are slow to look it up for each pixel.
    @location(3) @interpolate(flat) sphere: vec4<f32>,
    @location(4) @interpolate(flat) colour: vec4<f32>,
    @location(5) @interpolate(flat) hidden_a: vec4<f32>,
    @location(6) @interpolate(flat) hidden_b: vec4<f32>,
    @location(7) @interpolate(flat) turned: vec4<f32>,
    @location(8) @interpolate(flat) wet: f32,
}

struct Painted {
    @location(0) colour: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vertex(corner: Corner) -> Covered {
    let index = u32(corner.place.z + 0.5);
    let grain = grains[index];
    var covered: Covered;
    covered.sphere = vec4<f32>(grain.centre, grain.radius);
    let shadow = shadows[index];
    covered.colour = vec4<f32>(grain.colour, shadow.mean);
    covered.hidden_a = vec4<f32>(shadow.x, shadow.y, shadow.z, shadow.xx);
    covered.hidden_b = vec4<f32>(shadow.yy, shadow.xy, shadow.yz, shadow.zx);
    covered.turned = grain.orientation;
    covered.wet = grain.wet;

    // Selected, not branched to, as in `ray_through`.
    let parallel = orthographic();
    let ray = ray_through(grain.centre);
    let forward = ray.direction;
    let distance = select(length(grain.centre - view.world_position), 1.0, parallel);
    let tangent = distance * distance - grain.radius * grain.radius;
    let seen = select(0.0, grain.radius * distance * inverseSqrt(tangent), tangent > 0.0);
    var outline = select(seen, grain.radius, parallel);
    let pixel = 2.0 * distance / (view.clip_from_view[1][1] * view.viewport.w);
    if is_sphere_cut_away(cut, grain.centre, grain.radius) {
        outline = 0.0;
    }

    // One pixel more on each side for the soft edge.
    covered.pixel = select(0.0, pixel / outline, outline > 0.0);
    covered.across = corner.place.xy * (1.0 + covered.pixel);
    let up = view.world_from_view[1].xyz;
    let side = normalize(cross(forward, up));
    let upward = cross(side, forward);
    covered.world = grain.centre + outline * (covered.across.x * side + covered.across.y * upward);
    covered.position = view.clip_from_world * vec4<f32>(covered.world, 1.0);
    return covered;
}

fn grain_of(covered: Covered) -> Grain {
    return Grain(covered.sphere.xyz, covered.sphere.w, covered.colour.xyz, covered.wet, covered.turned);
}

fn shadow_of(covered: Covered) -> Shadow {
    let a = covered.hidden_a;
    let b = covered.hidden_b;
    return Shadow(covered.colour.w, a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w);
}

@fragment
fn fragment(covered: Covered) -> Painted {
    let grain = grain_of(covered);
    let from_middle = length(covered.across);
    let coverage = clamp(0.5 + (1.0 - from_middle) / covered.pixel, 0.0, 1.0);
#ifdef MULTISAMPLED
    if coverage <= 0.0 { discard; }
#else
    if from_middle > 1.0 { discard; }
#endif

    let ray = ray_through(covered.world);
    let away = ray.origin - grain.centre;
    let b = dot(away, ray.direction);
    // Beyond the outline, in the soft edge, the ray is taken to touch.
    let half_chord = sqrt(max(b * b - dot(away, away) + grain.radius * grain.radius, 0.0));
    var hit = ray.origin + (-b - half_chord) * ray.direction;
    let normal = normalize(hit - grain.centre);

    var light: vec3<f32>;
    if is_cut_away(cut, hit) {
        // The near side is cut away: the ray goes on to the section, if it meets it within the grain.
        let exit = exit_from_cut(cut, ray);
        if exit.t > -b + half_chord { discard; }
        hit = ray.origin + exit.t * ray.direction;
        light = section_of(grain, hit, exit.plane, covered.pixel * grain.radius);
    } else {
        light = surface(grain, shadow_of(covered), normal, -ray.direction, covered.pixel);
    }

    let clip = view.clip_from_world * vec4<f32>(hit, 1.0);
    return Painted(vec4<f32>(light, coverage), clip.z / clip.w);
}

// The skin, a little darker where it turns away.
fn surface(grain: Grain, shadow: Shadow, normal: vec3<f32>, to_eye: vec3<f32>, pixel: f32) -> vec3<f32> {
    let facing = max(dot(normal, to_eye), 0.0);
    let turned_away = mix(0.55, 1.0, smoothstep(0.0, 0.7, facing));
    let painted = pattern(grain.orientation, normal, pixel);
    let colour = mix(grain.colour * painted.x, vec3<f32>(0.9), painted.y);
    return skin(colour * turned_away, open_sky(shadow, normal), normal, to_eye, grain.wet);
}

// The section by a plane: a disc.
fn section_of(grain: Grain, hit: vec3<f32>, plane: vec4<f32>, pixel: f32) -> vec3<f32> {
    let beyond = plane.w - dot(plane.xyz, grain.centre);
    let radius = sqrt(max(grain.radius * grain.radius - beyond * beyond, 0.0));
    let from_rim = radius - length(hit - grain.centre - beyond * plane.xyz);
    return section(grain.colour, cut, plane, hit, from_rim, 0.09 * grain.radius + pixel);
}
