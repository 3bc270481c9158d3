#include "importers/gltf/reader.h"

static const char repair[] = "repair the file in the tool that wrote it";

static bool check_node(const gltf_reader *r, const gltf_node *n, const kiln_where *where) {
    const gltf_document *d = &r->document;
    return gltf_check_key(r, n->mesh, d->mesh_count, "mesh", where, "mesh") &&
           gltf_check_key(r, n->skin, d->skin_count, "skin", where, "skin") &&
           gltf_check_key(r, n->camera, d->camera_count, "camera", where, "camera");
}

/* Every node has one parent at most (glTF 2.0, section 3.5.2: the hierarchy is a set of disjoint strict trees). */
static bool find_parents(const gltf_reader *r, int *parents) {
    const gltf_document *d = &r->document;
    for (size_t i = 0; i < d->node_count; i++) parents[i] = -1;
    for (size_t i = 0; i < d->node_count; i++) {
        gltf_indices children = d->nodes[i].children;
        kiln_where node = where_item(&r->file, "nodes", i);
        for (size_t c = 0; c < children.count; c++) {
            kiln_where where = where_item(&node, "children", c);
            if (!gltf_check_index(r, children.items[c], d->node_count, false, "node", &where)) return false;
            int *parent = &parents[children.items[c]];
            if (*parent >= 0)
                return report_error(r->report, KILN_CODE_REFERENCE, &where, repair,
                                    "node %d is a child of node %d already", children.items[c], *parent);
            *parent = (int)i;
        }
    }
    return true;
}

/* Each walk up marks nodes with its number, and ends at a root, at a node of an earlier walk, or at one of its own: a
 * loop. Every node is marked once. */
static bool check_loops(const gltf_reader *r, const int *parents, uint32_t *marks) {
    for (size_t i = 0; i < r->document.node_count; i++) {
        uint32_t walk = (uint32_t)i + 1;
        int at = (int)i;
        while (at >= 0 && !marks[at]) {
            marks[at] = walk;
            at = parents[at];
        }
        if (at < 0 || marks[at] != walk) continue;
        kiln_where where = where_item(&r->file, "nodes", (size_t)at);
        return report_error(r->report, KILN_CODE_REFERENCE, &where, repair, "the node is its own ancestor");
    }
    return true;
}

static bool check_scenes(const gltf_reader *r, const int *parents, uint32_t *marks) {
    const gltf_document *d = &r->document;
    for (size_t i = 0; i < d->node_count; i++) marks[i] = 0;
    for (size_t s = 0; s < d->scene_count; s++) {
        kiln_where scene = where_item(&r->file, "scenes", s);
        for (size_t i = 0; i < d->scenes[s].count; i++) {
            int node = d->scenes[s].items[i];
            kiln_where where = where_item(&scene, "nodes", i);
            if (!gltf_check_index(r, node, d->node_count, false, "node", &where)) return false;
            if (parents[node] >= 0)
                return report_error(r->report, KILN_CODE_REFERENCE, &where, repair,
                                    "node %d is a child of node %d, and cannot be a root too", node, parents[node]);
            if (marks[node] == s + 1)
                return report_error(r->report, KILN_CODE_REFERENCE, &where, repair, "node %d is there twice", node);
            marks[node] = (uint32_t)s + 1;
        }
    }
    kiln_where where = where_key(&r->file, "scene");
    return gltf_check_index(r, d->scene, d->scene_count, true, "scene", &where);
}

bool gltf_check_nodes(gltf_reader *r) {
    size_t count = r->document.node_count;
    for (size_t i = 0; i < count; i++) {
        kiln_where where = where_item(&r->file, "nodes", i);
        if (!check_node(r, &r->document.nodes[i], &where)) return false;
    }
    int *parents = reader_array(r, count, sizeof *parents, &r->file);
    uint32_t *marks = parents ? reader_array(r, count, sizeof *marks, &r->file) : NULL;
    return marks && find_parents(r, parents) && check_loops(r, parents, marks) && check_scenes(r, parents, marks);
}
