#include <string.h>

#include "importers/gltf/reader.h"
#include "importers/gltf/value.h"

static const char repair[] = "repair the file in the tool that wrote it";

/* Section 3.5.3: a matrix, or translation · rotation · scale. */
static mat4 local_transform(const gltf_node *n) {
    double t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    if (n->matrix.count) return mat4_load(n->matrix.items);
    if (n->translation.count) memcpy(t, n->translation.items, sizeof t);
    if (n->scale.count) memcpy(s, n->scale.items, sizeof s);
    if (n->rotation.count) memcpy(q, n->rotation.items, sizeof q);
    return mat4_trs(t, q, s);
}

/* Section 3.10.2: the scale of a camera's node is ignored. Mirroring and shear go too; what has no direction left stays
 * for the scene to refuse. */
static mat4 without_scale(const mat4 *m) {
    dvec3 z = d3_normalize(d3_load(m->m + 8)), x = d3_load(m->m);
    x = d3_normalize(d3_sub(x, d3_scale(z, d3_dot(x, z))));
    dvec3 y = d3_cross(z, x);
    return (mat4){{x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, m->m[12], m->m[13], m->m[14], 1}};
}

static bool add_camera(gltf_reader *r, const gltf_node *n, const mat4 *transform) {
    const gltf_camera *c = &r->document.cameras[n->camera];
    kiln_camera camera = kiln_camera_default();
    camera.name = *c->name ? c->name : n->name;
    if (c->orthographic) {
        camera.projection = KILN_ORTHOGRAPHIC;
        camera.xmag = c->xmag;
        camera.ymag = c->ymag;
        camera.aspect = c->ymag != 0 ? fabs(c->xmag / c->ymag) : 0;
    } else {
        camera.yfov_rad = c->yfov;
        camera.aspect = c->aspect;
    }
    camera.znear = c->znear;
    camera.zfar = c->zfar;
    const mat4 frame = without_scale(transform);
    memcpy(camera.transform, frame.m, sizeof camera.transform);
    kiln_where where = where_item(&r->file, "cameras", (size_t)n->camera);
    scene_locate(r->scene, &where);
    bool added = kiln_scene_add_camera(r->scene, &camera, NULL, r->report);
    scene_locate(r->scene, &r->file);
    return added;
}

/* KHR_lights_punctual, section "Inner and outer cone angles": 0 ≤ inner < outer ≤ π/2. */
static void read_cone(const gltf_reader *r, const gltf_light *l, kiln_light *light, const kiln_where *where) {
    const double right_angle = 1.5707963267948966;
    double inner = l->inner_cone, outer = l->outer_cone;
    if (!(outer > 0 && outer <= right_angle * (1 + 1e-6)) || !(inner >= 0 && inner < outer))
        report_warning(r->report, KILN_CODE_RANGE, where, NULL,
                       "cone angles must be 0 <= inner < outer <= pi/2: they are clamped");
    outer = outer > 0 ? fmin(outer, right_angle) : 0;
    inner = inner >= 0 ? fmin(inner, outer) : 0;
    light->inner_cone_rad = (float)inner;
    light->outer_cone_rad = (float)outer;
}

static bool read_kind(const gltf_reader *r, const gltf_light *l, kiln_light *light, const kiln_where *where) {
    static const struct { const char *name; kiln_light_kind kind; } rows[] = {
        {"point", KILN_LIGHT_POINT}, {"spot", KILN_LIGHT_SPOT}, {"directional", KILN_LIGHT_DISTANT}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (strcmp(l->type, rows[i].name) == 0) {
            light->kind = rows[i].kind;
            return true;
        }
    kiln_where here = where_key(where, "type");
    return report_error(r->report, KILN_CODE_RANGE, &here, "use point, spot or directional",
                        "\"%.40s\" is no kind of light", l->type);
}

static bool add_light(gltf_reader *r, int index, const gltf_node *n, const mat4 *transform) {
    const gltf_light *l = &r->document.lights[index];
    kiln_where extensions = where_key(&r->file, "extensions"), punctual = where_key(&extensions, "KHR_lights_punctual"),
               where = where_item(&punctual, "lights", (size_t)index);
    kiln_light light = kiln_light_default();
    light.name = *l->name ? l->name : n->name;
    light.intensity = (float)l->intensity;
    memcpy(light.transform, transform->m, sizeof light.transform);
    if (!read_kind(r, l, &light, &where)) return false;
    if (l->color.count && l->color.count != 3) {
        kiln_where color = where_key(&where, "color");
        return report_error(r->report, KILN_CODE_RANGE, &color, repair, "%zu numbers (3 are expected)", l->color.count);
    }
    for (size_t k = 0; k < l->color.count; k++) light.color[k] = (float)l->color.items[k];
    if (light.kind == KILN_LIGHT_SPOT) read_cone(r, l, &light, &where);
    scene_locate(r->scene, &where);
    bool added = kiln_scene_add_light(r->scene, &light, NULL, r->report);
    scene_locate(r->scene, &r->file);
    return added;
}

/* A node on its way to the scene; its parent's transform comes along. */
typedef struct visit {
    int node;
    size_t root;
    uint32_t parent; /* in the list that the scene keeps */
    bool visible;
    mat4 transform; /* of the parent */
} visit;

/* v->visible: that of the parent, then that of the node and its descendants (KHR_node_visibility). Cameras need not be
 * visible. */
static bool enter_node(gltf_reader *r, visit *v, const mat4 *transform) {
    const int index = v->node;
    const gltf_document *d = &r->document;
    const gltf_node *n = &d->nodes[index];
    kiln_where node = where_item(&r->file, "nodes", (size_t)index), list = where_key(&node, "extensions"),
               visibility = where_key(&list, "KHR_node_visibility"), punctual = where_key(&list, "KHR_lights_punctual");
    int light = -1;
    bool shown = true;
    if (!value_bool(value_member(&n->extensions, "KHR_node_visibility"), "visible", &shown, &visibility, r->report) ||
        !value_index(value_member(&n->extensions, "KHR_lights_punctual"), "light", &light, &punctual, r->report) ||
        !gltf_check_key(r, light, d->light_count, "light", &punctual, "light"))
        return false;
    if (n->camera >= 0 && !add_camera(r, n, transform)) return false;
    v->visible &= shown;
    if (!v->visible) return true;
    if (n->mesh >= 0) r->placements[r->placement_count++] = (gltf_placement){(size_t)index, v->root, *transform};
    return light < 0 || add_light(r, light, n, transform);
}

/* Keeps what inspect shows of a node. Cameras and lights were added last, if at all. */
static bool keep_node(gltf_reader *r, const gltf_node *n, const visit *v, const mat4 *local, kiln_scene_counts before) {
    kiln_scene *scene = r->scene;
    scene_node *kept = &r->nodes[scene->source.node_count++];
    *kept = (scene_node){.name = arena_string(&scene->arena, n->name),
                         .parent = v->parent,
                         .mesh = n->mesh < 0 ? 0 : (kiln_id)n->mesh + 1,
                         .camera = scene->camera_count > before.cameras ? scene->camera_count : 0,
                         .light = scene->light_count > before.lights ? scene->light_count : 0,
                         .local = *local};
    return kept->name || report_no_memory(r->report, "reading a glTF file");
}

/* Depth first, first child first. Trees were checked: each node is pushed once, so count entries are enough. */
static bool walk(gltf_reader *r, const int *roots, size_t root_count, visit *stack) {
    size_t top = 0;
    for (size_t i = root_count; i-- > 0;) stack[top++] = (visit){roots[i], (size_t)roots[i], SCENE_NO_PARENT, true, mat4_identity()};
    while (top) {
        visit v = stack[--top];
        const gltf_node *n = &r->document.nodes[v.node];
        const kiln_scene_counts before = {.cameras = r->scene->camera_count, .lights = r->scene->light_count};
        uint32_t place = r->scene->source.node_count;
        mat4 local = local_transform(n), transform = mat4_mul(v.transform, local);
        if (!enter_node(r, &v, &transform) || !keep_node(r, n, &v, &local, before)) return false;
        for (size_t c = n->children.count; c-- > 0;)
            stack[top++] = (visit){n->children.items[c], v.root, place, v.visible, transform};
    }
    return true;
}

void gltf_link_nodes(gltf_reader *r) {
    for (uint32_t i = 0; i < r->scene->source.node_count; i++)
        if (r->nodes[i].mesh) r->nodes[i].mesh = r->meshes[r->nodes[i].mesh - 1];
}

/* Without any scene, all nodes that are nobody's children. */
static bool find_roots(gltf_reader *r, gltf_indices *found) {
    const gltf_document *d = &r->document;
    bool *is_child = reader_array(r, d->node_count, sizeof *is_child, &r->file);
    int *roots = is_child ? reader_array(r, d->node_count, sizeof *roots, &r->file) : NULL;
    if (!roots) return false;
    *found = (gltf_indices){roots, 0};
    for (size_t i = 0; i < d->node_count; i++)
        for (size_t c = 0; c < d->nodes[i].children.count; c++) is_child[d->nodes[i].children.items[c]] = true;
    for (size_t i = 0; i < d->node_count; i++)
        if (!is_child[i]) roots[found->count++] = (int)i;
    return true;
}

bool gltf_place_nodes(gltf_reader *r) {
    const gltf_document *d = &r->document;
    r->placements = reader_array(r, d->node_count, sizeof *r->placements, &r->file);
    visit *stack = r->placements ? reader_array(r, d->node_count, sizeof *stack, &r->file) : NULL;
    if (!stack || !reader_reserve(r, d->node_count * sizeof *r->nodes, &r->file))
        return false;
    r->nodes = ARENA_ARRAY(&r->scene->arena, scene_node, d->node_count);
    r->scene->source.nodes = r->nodes;
    if (!r->nodes) return report_no_memory(r->report, "reading a glTF file");
    gltf_indices roots;
    if (d->scene_count) roots = d->scenes[d->scene < 0 ? 0 : d->scene];
    else if (!find_roots(r, &roots)) return false;
    return walk(r, roots.items, roots.count, stack);
}
