#include <string.h>

#include "importers/gltf/accessor.h"
#include "importers/gltf/value.h"

static bool add_instance(gltf_reader *r, const gltf_placement *p, const mat4 *transform) {
    const gltf_node *node = &r->document.nodes[p->node];
    kiln_id mesh = r->meshes[node->mesh];
    if (!mesh) return true; /* it had no surface */
    kiln_where where = where_item(&r->file, "nodes", p->node);
    kiln_instance_desc desc = {.name = *node->name ? node->name : r->document.meshes[node->mesh].name,
                               .asset = r->document.nodes[p->root].name, .mesh = mesh,
                               .transforms = transform->m};
    scene_locate(r->scene, &where);
    bool added = kiln_scene_add_instance(r->scene, &desc, NULL, r->report);
    scene_locate(r->scene, &r->file);
    return added;
}

/* EXT_mesh_gpu_instancing: an attribute of all instances, or NULL when it is not there. */
static bool read_attribute(gltf_reader *r, const gltf_value *attributes, const char *name, uint32_t width, size_t *count,
                           float **values, const kiln_where *list) {
    kiln_where where = where_key(list, name);
    int accessor = -1;
    *values = NULL;
    if (!value_index(attributes, name, &accessor, list, r->report)) return false;
    if (accessor < 0) return true;
    if (!gltf_check_index(r, accessor, r->document.accessor_count, false, "accessor", &where)) return false;
    const gltf_accessor *a = &r->document.accessors[accessor];
    if (a->columns != 1 || a->rows != width)
        return report_error(r->report, KILN_CODE_RANGE, &where, NULL, "accessor %d must hold vectors of %u numbers",
                            accessor, width);
    if (*count && a->count != *count)
        return report_error(r->report, KILN_CODE_RANGE, &where, NULL, "%zu values for %zu instances", a->count, *count);
    *count = a->count;
    *values = reader_array(r, a->count, width * sizeof **values, &where);
    return *values && accessor_floats(r, accessor, width, *values, &where);
}

static void load_row(double *out, const float *values, size_t index, size_t width) {
    for (size_t k = 0; values && k < width; k++) out[k] = (double)values[index * width + k];
}

static bool add_copies(gltf_reader *r, const gltf_placement *p, const gltf_value *attributes, const kiln_where *list) {
    size_t count = 0;
    float *translations, *rotations, *scales;
    if (!read_attribute(r, attributes, "TRANSLATION", 3, &count, &translations, list) ||
        !read_attribute(r, attributes, "ROTATION", 4, &count, &rotations, list) ||
        !read_attribute(r, attributes, "SCALE", 3, &count, &scales, list))
        return false;
    for (size_t i = 0; i < count; i++) {
        double t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
        load_row(t, translations, i, 3);
        load_row(q, rotations, i, 4);
        load_row(s, scales, i, 3);
        mat4 transform = mat4_mul(p->transform, mat4_trs(t, q, s));
        if (!add_instance(r, p, &transform)) return false;
    }
    return true;
}

bool gltf_add_instances(gltf_reader *r) {
    for (size_t i = 0; i < r->placement_count; i++) {
        const gltf_placement *p = &r->placements[i];
        const gltf_value *instancing = value_member(&r->document.nodes[p->node].extensions, "EXT_mesh_gpu_instancing");
        const gltf_value *attributes = value_member(instancing, "attributes");
        kiln_where node = where_item(&r->file, "nodes", p->node), extensions = where_key(&node, "extensions"),
                   where = where_key(&extensions, "EXT_mesh_gpu_instancing"), list = where_key(&where, "attributes");
        if (attributes ? !add_copies(r, p, attributes, &list) : !add_instance(r, p, &p->transform)) return false;
    }
    return true;
}
