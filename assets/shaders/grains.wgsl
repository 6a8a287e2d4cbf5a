// Spheres, each raymarched on a quad that just covers its outline: exact outline, depth and section at every size.

#import bevy_pbr::mesh_view_bindings::view
#import grainfall::light::{matt_light, gloss}

struct Grain {
    centre: vec3<f32>,
    radius: f32,
    colour: vec3<f32>,
    // Share of the sky that neighbours hide: mean, gradient and quadrupole over the normal.
    hidden_mean: f32,
    hidden_gradient: vec3<f32>,
    hidden_xx: f32,
    hidden_yy: f32,
    hidden_xy: f32,
    hidden_yz: f32,
    hidden_zx: f32,
}

struct Picture {
    // What lies beyond `dot(normal, x) = offset` is cut away; a zero normal cuts nothing.
    cut_normal: vec3<f32>,
    cut_offset: f32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<storage, read> grains: array<Grain>;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var<uniform> picture: Picture;

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
}

struct Painted {
    @location(0) colour: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

fn orthographic() -> bool {
    return view.clip_from_view[3][3] == 1.0;
}

// The ray of sight through a point of the world.
fn ray_through(x: vec3<f32>) -> Ray {
    if orthographic() {
        return Ray(x, -normalize(view.world_from_view[2].xyz));
    }
    return Ray(view.world_position, normalize(x - view.world_position));
}

@vertex
fn vertex(corner: Corner) -> Covered {
    let index = u32(corner.place.z + 0.5);
    let grain = grains[index];
    var covered: Covered;
    covered.sphere = vec4<f32>(grain.centre, grain.radius);
    covered.colour = vec4<f32>(grain.colour, grain.hidden_mean);
    covered.hidden_a = vec4<f32>(grain.hidden_gradient, grain.hidden_xx);
    covered.hidden_b = vec4<f32>(grain.hidden_yy, grain.hidden_xy, grain.hidden_yz, grain.hidden_zx);

    let offset = grain.centre - view.world_position;
    var forward = -normalize(view.world_from_view[2].xyz);
    var outline = grain.radius;
    var pixel = 2.0 / (view.clip_from_view[1][1] * view.viewport.w);
    if !orthographic() {
        let distance = length(offset);
        forward = offset / distance;
        let tangent = distance * distance - grain.radius * grain.radius;
        outline = select(0.0, grain.radius * distance * inverseSqrt(tangent), tangent > 0.0);
        pixel *= distance;
    }
    if dot(picture.cut_normal, grain.centre) - grain.radius > picture.cut_offset {
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

fn handed_over(covered: Covered) -> Grain {
    return Grain(
        covered.sphere.xyz, covered.sphere.w,
        covered.colour.xyz, covered.colour.w,
        covered.hidden_a.xyz, covered.hidden_a.w,
        covered.hidden_b.x, covered.hidden_b.y, covered.hidden_b.z, covered.hidden_b.w,
    );
}

@fragment
fn fragment(covered: Covered) -> Painted {
    let grain = handed_over(covered);
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
    var t = -b - half_chord;
    var hit = ray.origin + t * ray.direction;
    var normal = normalize(hit - grain.centre);
    let to_eye = -ray.direction;

    var light: vec3<f32>;
    if dot(picture.cut_normal, hit) > picture.cut_offset {
        // The near side is cut away: the ray goes on to the section, if it meets it within the grain.
        let approach = -dot(picture.cut_normal, ray.direction);
        if approach <= 0.0 { discard; }
        t = (dot(picture.cut_normal, ray.origin) - picture.cut_offset) / approach;
        if t > -b + half_chord { discard; }
        hit = ray.origin + t * ray.direction;
        light = section(grain, hit, covered.pixel * grain.radius);
    } else {
        light = surface(grain, normal, to_eye);
    }

    let clip = view.clip_from_world * vec4<f32>(hit, 1.0);
    return Painted(vec4<f32>(light, coverage), clip.z / clip.w);
}

// How much of the sky the neighbours leave open where the surface has this normal.
fn open_sky(grain: Grain, n: vec3<f32>) -> f32 {
    let squares = grain.hidden_xx * n.x * n.x + grain.hidden_yy * n.y * n.y
        - (grain.hidden_xx + grain.hidden_yy) * n.z * n.z;
    let products = grain.hidden_xy * n.x * n.y + grain.hidden_yz * n.y * n.z + grain.hidden_zx * n.z * n.x;
    let hidden = grain.hidden_mean + dot(grain.hidden_gradient, n) + squares + 2.0 * products;
    // Three orders blur what a neighbour hides; half as much again brings the depth of a gap back.
    return clamp(1.0 - 1.5 * hidden, 0.0, 1.0);
}

// A grain's skin: matt with a soft gloss, darker in the gaps between grains and a little where it turns away.
fn surface(grain: Grain, normal: vec3<f32>, to_eye: vec3<f32>) -> vec3<f32> {
    let facing = max(dot(normal, to_eye), 0.0);
    let turned = mix(0.55, 1.0, smoothstep(0.0, 0.7, facing));
    let sky = mix(0.16, 1.0, open_sky(grain, normal));
    let shine = 0.18 * sky * gloss(normal, to_eye);
    return grain.colour * matt_light(normal) * turned * sky + vec3<f32>(shine);
}

// A flat section with a darker rim.
fn section(grain: Grain, hit: vec3<f32>, pixel: f32) -> vec3<f32> {
    let beyond = picture.cut_offset - dot(picture.cut_normal, grain.centre);
    let section_radius = sqrt(max(grain.radius * grain.radius - beyond * beyond, 0.0));
    let from_rim = section_radius - length(hit - grain.centre - beyond * picture.cut_normal);
    let rim = smoothstep(0.0, 0.09 * grain.radius + pixel, from_rim);
    let pale = mix(grain.colour, vec3<f32>(1.0), 0.12);
    return mix(grain.colour * 0.35, pale, rim);
}
