#include "job/inspect.h"

#include <stdlib.h>

#include "job/effects.h"
#include "job/stats.h"
#include "scene/scene.h"

static json_t *source_facts(const job_run *r) {
    const scene_source *s = &r->scene->source;
    json_t *o = json_object(), *extensions = json_array();
    put_text(o, "file", r->source);
    put(o, "format", s->format ? json_text_of(s->format) : json_null());
    put(o, "generator", s->generator ? json_text_of(s->generator) : json_null());
    put(o, "copyright", s->copyright ? json_text_of(s->copyright) : json_null());
    for (uint32_t i = 0; i < s->extension_count; i++) {
        json_t *row = json_object();
        put_text(row, "name", s->extensions[i].name);
        put_bool(row, "required", s->extensions[i].required);
        put_text(row, "support", s->extensions[i].support);
        (void)json_array_append_new(extensions, row);
    }
    put(o, "extensions", extensions);
    return o;
}

static json_t *counts(const job_run *r) {
    kiln_scene_counts c = kiln_scene_count(r->scene);
    json_t *o = json_object();
    put_count(o, "instances", c.instances);
    put_count(o, "meshes", c.meshes);
    put_count(o, "triangles", c.triangles);
    put_count(o, "triangles_unique", c.triangles_unique);
    put_count(o, "triangles_before_subdivision", r->cage_triangles);
    put_count(o, "materials", c.materials);
    put_count(o, "images", r->asset_images);
    put_count(o, "lights", c.lights);
    put_count(o, "cameras", c.cameras);
    return o;
}

static json_t *primvars(const kiln_mesh *m) {
    static const char *const kinds[] = {[KILN_PRIMVAR_NORMAL] = "normal", [KILN_PRIMVAR_TANGENT] = "tangent",
                                        [KILN_PRIMVAR_UV] = "uv", [KILN_PRIMVAR_COLOR] = "color"};
    json_t *array = json_array();
    for (uint32_t i = 0; i < m->primvar_count; i++) {
        kiln_text name = {0};
        text_append(&name, kinds[m->primvars[i].kind]);
        if (m->primvars[i].kind == KILN_PRIMVAR_UV) text_format(&name, "%u", m->primvars[i].set);
        (void)json_array_append_new(array, json_text_of(name.data));
        text_free(&name);
    }
    return array;
}

static json_t *subdivision(const kiln_subdivision_result *row) {
    static const char *const schemes[] = {[KILN_SCHEME_NONE] = "none", [KILN_SCHEME_CATMULL_CLARK] = "catmull-clark",
                                          [KILN_SCHEME_LOOP] = "loop", [KILN_SCHEME_BILINEAR] = "bilinear",
                                          [KILN_SCHEME_AUTO] = "auto"};
    json_t *o = json_object();
    put_bool(o, "refined", row->refined);
    put_text(o, "scheme", schemes[row->scheme]);
    put_count(o, "level", row->level);
    put_number(o, "quad_rate", row->quad_rate);
    put_text(o, "reason", row->reason);
    return o;
}

static json_t *meshes(const job_run *r) {
    json_t *array = json_array();
    uint32_t *uses = array_alloc(r->scene->mesh_count, sizeof *uses);
    for (uint32_t i = 0; uses && i < r->scene->instance_count; i++) uses[r->scene->instances[i].mesh - 1]++;
    for (uint32_t i = 0; i < r->scene->mesh_count; i++) {
        const kiln_mesh *m = &r->scene->meshes[i];
        json_t *o = json_object();
        put_text(o, "name", m->name);
        put_count(o, "instances", uses ? uses[i] : 0);
        put_count(o, "vertices", m->vertex_count);
        put_count(o, "faces", m->face_count);
        put_count(o, "triangles", m->triangle_count);
        put(o, "primvars", primvars(m));
        put(o, "material", m->material ? json_integer(m->material - 1) : json_null());
        if (i < r->subdivision_count) put(o, "subdivision", subdivision(&r->subdivisions[i]));
        (void)json_array_append_new(array, o);
    }
    free(uses);
    return array;
}

static json_t *lights(const kiln_scene *scene) {
    static const char *const kinds[] = {[KILN_LIGHT_POINT] = "point", [KILN_LIGHT_SPOT] = "spot",
                                        [KILN_LIGHT_DISTANT] = "directional"};
    json_t *array = json_array();
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const kiln_light *l = &scene->lights[i];
        mat4 m = mat4_load(l->transform);
        dvec3 axis = d3_normalize(mat4_vector(&m, (dvec3){0, 0, -1}));
        double direction[3] = {axis.x, axis.y, axis.z};
        json_t *o = json_object();
        put_text(o, "name", l->name);
        put_text(o, "kind", kinds[l->kind]);
        put_number(o, "intensity", (double)l->intensity);
        put_text(o, "unit", l->kind == KILN_LIGHT_DISTANT ? "lx" : "cd");
        put(o, "color", json_floats_of(l->color, 3));
        if (l->kind != KILN_LIGHT_DISTANT) put(o, "position", json_numbers_of(l->transform + 12, 3));
        if (l->kind != KILN_LIGHT_POINT) put(o, "direction", json_numbers_of(direction, 3));
        if (l->kind == KILN_LIGHT_SPOT) {
            put_number(o, "inner_cone_deg", (double)l->inner_cone_rad * 180 / M_PI);
            put_number(o, "outer_cone_deg", (double)l->outer_cone_rad * 180 / M_PI);
        }
        (void)json_array_append_new(array, o);
    }
    return array;
}

static json_t *cameras(const kiln_scene *scene) {
    json_t *array = json_array();
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        job_view view = {.camera = scene->cameras[i], .name = (char *)scene->cameras[i].name};
        json_t *o = stats_camera(&view);
        json_object_del(o, "automatic");
        put(o, "aspect", view.camera.aspect > 0 ? json_number_of(view.camera.aspect) : json_null());
        put_number(o, "znear", view.camera.znear);
        put(o, "zfar", view.camera.zfar > 0 ? json_number_of(view.camera.zfar) : json_null());
        (void)json_array_append_new(array, o);
    }
    return array;
}

static json_t *rendering(const job_run *r) {
    json_t *o = json_object();
    put_count(o, "width", r->view.width);
    put_count(o, "height", r->view.height);
    put(o, "camera", stats_camera(&r->view));
    put_text(o, "light", lighting_describe(&r->lighting, r->options));
    return o;
}

/* The renderer keeps three indices and a material of a triangle; a vertex for every combination of values, with its
 * tangent where normals are mapped. */
static uint64_t geometry_bytes(const kiln_mesh *m) {
    enum { TRIANGLE_BYTES = 16, VERTEX_BYTES = 32, TANGENT_BYTES = 16 };
    uint64_t vertices = m->vertex_count;
    for (uint32_t i = 0; i < m->primvar_count; i++)
        if (m->primvars[i].value_count > vertices) vertices = m->primvars[i].value_count;
    bool tangents = mesh_primvar(m, KILN_PRIMVAR_TANGENT, 0) != NULL;
    return m->triangle_count * (uint64_t)TRIANGLE_BYTES +
           vertices * (uint64_t)(VERTEX_BYTES + (tangents ? TANGENT_BYTES : 0));
}

/* What a render with these options would hold. */
static json_t *memory_estimate(const job_run *r, uint64_t textures) {
    enum { BVH_BYTES = 70 }; /* of Embree for each triangle: 60 to 70 were measured */
    const job_layers *layers = &r->options->layers;
    kiln_film_desc film = {.width = r->view.width, .height = r->view.height, .aovs = layers->aovs,
                           .mattes = layers->mattes};
    (void)layers_parts(layers, r->scene, &film.parts, &film.part_count, r->report); /* reported: then without them */
    uint64_t geometry = 0, bvh = kiln_scene_count(r->scene).triangles_unique * BVH_BYTES;
    for (uint32_t i = 0; i < r->scene->mesh_count; i++) geometry += geometry_bytes(&r->scene->meshes[i]);
    json_t *o = json_object();
    put_count(o, "textures", textures);
    put_count(o, "geometry", geometry);
    put_count(o, "acceleration", bvh);
    put_count(o, "film", kiln_film_size(&film));
    put_count(o, "total", textures + geometry + bvh + kiln_film_size(&film));
    free((void *)film.parts);
    return o;
}

static json_t *describe(const job_run *r) {
    uint64_t textures = 0;
    json_t *o = json_object();
    put(o, "source", source_facts(r));
    put(o, "counts", counts(r));
    put(o, "bounds", stats_bounds(kiln_scene_bounds(r->scene)));
    put(o, "nodes", inspect_nodes(r->scene));
    put(o, "instances", inspect_instances(r->scene));
    put(o, "meshes", meshes(r));
    put(o, "materials", inspect_materials(r->scene));
    put(o, "images", inspect_images(r->scene, r->asset_images, &textures));
    put(o, "lights", lights(r->scene));
    put(o, "cameras", cameras(r->scene));
    put(o, "rendering", rendering(r));
    put(o, "effects", effects_facts(&r->plan));
    put(o, "memory_estimate", memory_estimate(r, textures));
    put(o, "warnings", stats_messages(r->report, KILN_WARNING));
    return o;
}

bool inspect(job_run *r, json_t **json) {
    bool done = run_phase(r, "import") && run_import(r) && run_phase(r, "frame") && run_camera(r) &&
                run_phase(r, "subdivide") && run_subdivide(r) && run_phase(r, "light") && run_light(r) &&
                run_phase(r, "images") && run_plan(r) &&
                run_check_strict(r);
    run_phase(r, NULL);
    *json = done ? describe(r) : NULL;
    return done;
}
