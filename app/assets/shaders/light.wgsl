// The light that everything stands in: a sky that is brighter above, a key light over the viewer's left shoulder.

#define_import_path grainfall::light

#import bevy_pbr::mesh_view_bindings::view

// Direction towards the key light; it moves with the viewer, so that shapes read from everywhere.
fn key_direction() -> vec3<f32> {
    // A unit vector in the viewer's axes.
    return (view.world_from_view * vec4<f32>(-0.42025, 0.68041, 0.60036, 0.0)).xyz;
}

// Light that a matt surface of this normal sends back.
fn matt_light(normal: vec3<f32>) -> f32 {
    let sky = mix(0.38, 0.68, 0.5 + 0.5 * normal.y);
    // Wrapped, so that the terminator is soft.
    let key = max((dot(normal, key_direction()) + 0.25) / 1.25, 0.0);
    return sky + 0.62 * key;
}

// Gloss of the key light towards the eye.
fn gloss(normal: vec3<f32>, to_eye: vec3<f32>) -> f32 {
    let middle = normalize(key_direction() + to_eye);
    let facing = max(dot(normal, middle), 0.0);
    // To the 32nd power by squaring, far cheaper than `pow`.
    let p2 = facing * facing;
    let p4 = p2 * p2;
    let p8 = p4 * p4;
    let p16 = p8 * p8;
    return p16 * p16;
}
