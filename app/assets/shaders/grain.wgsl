// What all grains have in common: their entries in the buffers, the ray that sees them, their skin, and what is cut away.

#define_import_path grainfall::grain

#import bevy_pbr::mesh_view_bindings::view
#import grainfall::light::{matt_light, gloss}

struct Grain {
    centre: vec3<f32>,
    radius: f32,
    colour: vec3<f32>,
    // 1 where a liquid covers it, else 0.
    wet: f32,
    // From body axes to the world's; zeros of a sphere without a pattern.
    orientation: vec4<f32>,
}

// Share of the sky that neighbours hide from a grain: mean, gradient and quadrupole over the normal.
struct Shadow {
    mean: f32,
    x: f32,
    y: f32,
    z: f32,
    xx: f32,
    yy: f32,
    xy: f32,
    yz: f32,
    zx: f32,
}

// What lies beyond both planes, `dot(normal, x) > w`, is cut away.
struct Cut {
    planes: array<vec4<f32>, 2>,
}

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

// Where a ray comes out of what is cut away: the plane it meets there and the distance along the ray.
struct Exit {
    plane: vec4<f32>,
    t: f32,
}

const NEVER: f32 = 3e38;

fn orthographic() -> bool {
    return view.clip_from_view[3][3] == 1.0;
}

// The ray of sight through a point of the world. Selected, not branched to: some drivers compile a shader anew whenever a
// number that decides a branch is handed over.
fn ray_through(x: vec3<f32>) -> Ray {
    let parallel = orthographic();
    let origin = select(view.world_position, x, parallel);
    let away = select(x - view.world_position, -view.world_from_view[2].xyz, parallel);
    return Ray(origin, normalize(away));
}

fn is_cut_away(cut: Cut, x: vec3<f32>) -> bool {
    return dot(cut.planes[0].xyz, x) > cut.planes[0].w && dot(cut.planes[1].xyz, x) > cut.planes[1].w;
}

// Whether the whole sphere is cut away.
fn is_sphere_cut_away(cut: Cut, centre: vec3<f32>, radius: f32) -> bool {
    return dot(cut.planes[0].xyz, centre) - radius > cut.planes[0].w
        && dot(cut.planes[1].xyz, centre) - radius > cut.planes[1].w;
}

// The end of what is cut away from a ray; never for a ray that nothing is cut away from.
fn exit_from_cut(cut: Cut, ray: Ray) -> Exit {
    var exit = Exit(vec4<f32>(0.0), NEVER);
    for (var i = 0; i < 2; i++) {
        let plane = cut.planes[i];
        let other = cut.planes[1 - i];
        let approach = -dot(plane.xyz, ray.direction);
        if approach > 0.0 {
            let t = (dot(plane.xyz, ray.origin) - plane.w) / approach;
            let beyond_other = dot(other.xyz, ray.origin + t * ray.direction) >= other.w;
            if t < exit.t && beyond_other { exit = Exit(plane, t); }
        }
    }
    return exit;
}

// How much of the sky the neighbours leave open where the surface has this normal.
fn open_sky(shadow: Shadow, n: vec3<f32>) -> f32 {
    let squares = shadow.xx * n.x * n.x + shadow.yy * n.y * n.y - (shadow.xx + shadow.yy) * n.z * n.z;
    let products = shadow.xy * n.x * n.y + shadow.yz * n.y * n.z + shadow.zx * n.z * n.x;
    let gradient = vec3<f32>(shadow.x, shadow.y, shadow.z);
    let hidden = shadow.mean + dot(gradient, n) + squares + 2.0 * products;
    // Three orders blur what a neighbour hides; half as much again brings the depth of a gap back.
    return clamp(1.0 - 1.5 * hidden, 0.0, 1.0);
}

// A grain's skin: matt with a soft gloss, darker in the gaps between grains. A film of liquid makes it darker and mirrors
// the light in a small bright spot.
fn skin(colour: vec3<f32>, sky_open: f32, normal: vec3<f32>, to_eye: vec3<f32>, wet: f32) -> vec3<f32> {
    let sky = mix(0.16, 1.0, sky_open);
    let soft = gloss(normal, to_eye);
    let sharp = soft * soft * soft * soft;
    let shine = sky * (0.18 * soft + 0.8 * wet * sharp);
    return colour * matt_light(normal) * sky * mix(1.0, 0.8, wet) + vec3<f32>(shine);
}

// The vector `v` of the world in the axes of a body that is turned by `q`.
fn to_body(q: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    let t = 2.0 * cross(v, q.xyz);
    return v + q.w * t + cross(t, q.xyz);
}

// How a sphere is painted at this unit vector from its centre, so that one sees it turn: its half towards its own x axis
// dark, a pale band round its y axis. `pixel` is that of the picture in its radii. x: share of the colour that is kept,
// y: share of the band.
fn pattern(turned: vec4<f32>, normal: vec3<f32>, pixel: f32) -> vec2<f32> {
    let own = to_body(turned, normal);
    let soft = max(pixel, 0.01);
    let is_dark = smoothstep(-soft, soft, own.x);
    let is_band = 1.0 - smoothstep(0.13 - soft, 0.13 + soft, abs(own.y));
    // Nothing where there is no rotation.
    return vec2<f32>(1.0 - 0.62 * is_dark, 0.85 * is_band) * dot(turned, turned)
        + vec2<f32>(1.0 - dot(turned, turned), 0.0);
}

// A flat section at `hit` in this plane of the cut, `from_rim` inside its rim, which is darker over `breadth`, as is the
// edge between the two faces of a quarter. It is a drawing in the colour of the legend: no light falls on it.
fn section(colour: vec3<f32>, cut: Cut, plane: vec4<f32>, hit: vec3<f32>, from_rim: f32, breadth: f32) -> vec3<f32> {
    let is_first = all(plane == cut.planes[0]);
    let other = select(cut.planes[0], cut.planes[1], is_first);
    let from_edge = 2.0 * abs(dot(other.xyz, hit) - other.w);
    return mix(colour * 0.35, colour, smoothstep(0.0, breadth, min(from_rim, from_edge)));
}
