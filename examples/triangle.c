/* Builds a scene by hand, a red triangle above a grey floor under a lamp, and renders it by a job: triangle out.png */
#include <kiln/kiln.h>

#include <stdio.h>

static bool add_part(kiln_scene *scene, const float *positions, uint32_t vertices, const uint32_t *corners,
                     uint32_t faces, const kiln_material *material, kiln_report *report) {
    kiln_mesh_desc mesh = {
        .vertex_count = vertices, .positions = positions, .face_count = faces, .face_vertices = corners};
    kiln_instance_desc instance = {.name = material->name};
    return kiln_scene_add_material(scene, material, &mesh.material, report) &&
           kiln_scene_add_mesh(scene, &mesh, &instance.mesh, report) &&
           kiln_scene_add_instance(scene, &instance, NULL, report);
}

static bool build(kiln_scene *scene, kiln_report *report) {
    static const float triangle[] = {-1, 0, 0, 1, 0, 0, 0, 1.6f, 0}, floor[] = {-3, 0, 3, 3, 0, 3, 3, 0, -3, -3, 0, -3};
    static const uint32_t one[] = {0, 1, 2}, two[] = {0, 1, 2, 0, 2, 3};
    kiln_material red = kiln_material_default(), grey = kiln_material_default();
    red.name = "red";
    red.base_color.value[1] = red.base_color.value[2] = 0.05f;
    grey.name = "grey";
    for (int k = 0; k < 3; k++) grey.base_color.value[k] = 0.5f;
    red.metallic.value = grey.metallic.value = 0;
    red.double_sided = true;
    kiln_light lamp = kiln_light_default(); /* a point light: 20 cd, two metres up */
    lamp.intensity = 20;
    lamp.transform[12] = 1, lamp.transform[13] = 2, lamp.transform[14] = 2;
    return add_part(scene, triangle, 3, one, 1, &red, report) && add_part(scene, floor, 4, two, 2, &grey, report) &&
           kiln_scene_add_light(scene, &lamp, NULL, report);
}

int main(int argc, char **argv) {
    if (argc != 2) return fprintf(stderr, "usage: %s out.png\n", argv[0]), 2;
    kiln_report *report = kiln_report_create();
    kiln_scene *scene = kiln_scene_create();
    kiln_job *job = kiln_job_create();
    bool done = report && scene && job && build(scene, report) &&
                kiln_job_set(job, "output", argv[1], report) && kiln_job_set(job, "size", "320x240", report) &&
                kiln_job_set(job, "spp", "32", report) && kiln_job_render_scene(job, scene, "triangle", report);
    for (size_t i = 0; report && i < kiln_report_size(report); i++) {
        kiln_message m = kiln_report_message(report, i);
        fprintf(stderr, "%s: %s; %s\n", m.where, m.what, m.remedy);
    }
    kiln_job_destroy(job);
    kiln_scene_destroy(scene);
    kiln_report_destroy(report);
    return done ? 0 : 1;
}
