#include "render/light/tree.h"

#include <math.h>
#include <stdlib.h>

#include "base/vec.h"

enum { BINS = 16, AXES = 3 };

typedef struct box { vec3 low, high; } box;

/* A light that is to be placed: what splits ask of it, side by side. Intensities sum to 1. */
typedef struct item {
    float middle[AXES], intensity;
    box box;
    vec3 normal; /* times the intensity; 0: it has none, or two */
    uint32_t light;
} item;

typedef struct build {
    const light *lights;
    item *items;
    light_node *nodes;
    uint32_t node_count, node_room;
    uint64_t *trails;
} build;

/* Items [first, end), and what it would be worth to tell them apart. */
typedef struct range {
    uint32_t first, end;
    double cost;
} range;

/* Of some items: what bounds would be like. */
typedef struct bin {
    box box;
    vec3 normals; /* sum of intensity · normal, of lights that have one */
    double intensity;
    uint32_t count;
} bin;

static box box_empty(void) { return (box){v3_splat(INFINITY), v3_splat(-INFINITY)}; }
static vec3 lower(vec3 a, vec3 b) { return v3(fm_min(a.x, b.x), fm_min(a.y, b.y), fm_min(a.z, b.z)); }
static vec3 upper(vec3 a, vec3 b) { return v3(fm_max(a.x, b.x), fm_max(a.y, b.y), fm_max(a.z, b.z)); }

enum { CORNERS_MAX = 4 };
static int corners_of(const light *l, vec3 corners[CORNERS_MAX]) {
    corners[0] = l->position;
    if (l->kind != LIGHT_TRIANGLE) return 1;
    corners[1] = v3_add(l->position, l->e1);
    corners[2] = v3_add(l->position, l->e2);
    corners[3] = v3_add(corners[1], l->e2);
    return l->quad > 0.5f ? 4 : 3;
}

static box box_of(const light *l) {
    vec3 corners[CORNERS_MAX];
    box b = box_empty();
    for (int k = corners_of(l, corners); k-- > 0;) b.low = lower(b.low, corners[k]), b.high = upper(b.high, corners[k]);
    return b;
}

static bool has_normal(const light *l) { return l->kind != LIGHT_POINT; }

static void bin_add(bin *b, const item *x) {
    b->box.low = lower(b->box.low, x->box.low), b->box.high = upper(b->box.high, x->box.high);
    b->normals = v3_add(b->normals, x->normal);
    b->intensity += (double)x->intensity;
    b->count++;
}
static void bin_join(bin *a, const bin *b) {
    a->box.low = lower(a->box.low, b->box.low), a->box.high = upper(a->box.high, b->box.high);
    a->normals = v3_add(a->normals, b->normals);
    a->intensity += b->intensity;
    a->count += b->count;
}

/* How much the importance of a cluster is off, from point to point: its intensity, times its size squared, times what
 * its normals spread over, π steradians (one normal, by cosine) to 4π. Like Conty and Kulla's M_A M_Ω, but that a row of
 * points, whose box has no surface, has a size too, and that the spread is that of the mean normal's length. */
static double cost_of(const bin *b) {
    vec3 d = v3_sub(b->box.high, b->box.low);
    double size2 = (double)v3_dot(d, d), mean = b->intensity > 0 ? (double)v3_length(b->normals) / b->intensity : 0;
    return b->count ? b->intensity * size2 * (4 - 3 * fmin(mean, 1)) : 0;
}

static bin bin_of_range(const build *b, uint32_t first, uint32_t end) {
    bin r = {.box = box_empty()};
    for (uint32_t i = first; i < end; i++) bin_add(&r, &b->items[i]);
    return r;
}

static uint32_t bin_index(float middle, float low, float scale) {
    int k = (int)((middle - low) * scale);
    return (uint32_t)(k < 0 ? 0 : k >= BINS ? BINS - 1 : k);
}

/* A plane between bins. */
typedef struct split {
    double cost;
    int axis; /* −1: none */
    uint32_t bin;
    float low, scale;
} split;

/* The bounds of middles; NaN and infinities stay out of them. */
typedef struct extents { float low[AXES], high[AXES], longest; } extents;

static extents extents_of(const build *b, range r) {
    extents x = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, 0};
    for (uint32_t i = r.first; i < r.end; i++)
        for (int a = 0; a < AXES; a++) {
            x.low[a] = fm_min(b->items[i].middle[a], x.low[a]);
            x.high[a] = fm_max(b->items[i].middle[a], x.high[a]);
        }
    for (int a = 0; a < AXES; a++) x.longest = fm_max(x.longest, x.high[a] - x.low[a]);
    return x;
}

static void try_axis(const bin bins[BINS], int axis, const extents *x, float scale, split *best) {
    bin after[BINS], before = {.box = box_empty()};
    float extent = x->high[axis] - x->low[axis];
    after[BINS - 1] = bins[BINS - 1];
    for (int k = BINS - 2; k > 0; k--) {
        after[k] = bins[k];
        bin_join(&after[k], &after[k + 1]);
    }
    for (uint32_t k = 1; k < BINS; k++) {
        bin_join(&before, &bins[k - 1]);
        if (!before.count || !after[k].count) continue;
        /* Thin boxes come of cuts across short axes. */
        double cost = (cost_of(&before) + cost_of(&after[k])) * (double)(x->longest / extent);
        if (cost < best->cost) *best = (split){cost, axis, k, x->low[axis], scale};
    }
}

/* The best plane; none where all middles are one. */
static split find_split(const build *b, range r) {
    extents x = extents_of(b, r);
    split best = {.cost = INFINITY, .axis = -1};
    for (int a = 0; a < AXES; a++) {
        bin bins[BINS];
        float scale = (float)BINS / (x.high[a] - x.low[a]);
        /* An axis along which little happens would give thin boxes, or none. */
        if (!(x.high[a] - x.low[a] > 0x1p-10f * x.longest) || !(scale < INFINITY)) continue;
        for (int k = 0; k < BINS; k++) bins[k] = (bin){.box = box_empty()};
        for (uint32_t i = r.first; i < r.end; i++)
            bin_add(&bins[bin_index(b->items[i].middle[a], x.low[a], scale)], &b->items[i]);
        try_axis(bins, a, &x, scale, &best);
    }
    return best;
}

static int by_middle_x(const void *a, const void *b) {
    const item *x = a, *y = b;
    if (x->middle[0] != y->middle[0]) return x->middle[0] < y->middle[0] ? -1 : 1;
    return x->light < y->light ? -1 : x->light > y->light;
}

/* Where the second half of a range begins, which is put in order for it: 2 items at least. */
static uint32_t divide(const build *b, range r, bool evenly) {
    split best = evenly ? (split){.axis = -1} : find_split(b, r);
    if (best.axis < 0) {
        if (evenly) qsort(b->items + r.first, r.end - r.first, sizeof *b->items, by_middle_x);
        return r.first + (r.end - r.first) / 2;
    }
    uint32_t first = r.first, end = r.end;
    while (first < end) {
        item *x = &b->items[first];
        if (bin_index(x->middle[best.axis], best.low, best.scale) < best.bin) {
            first++;
        } else {
            item t = *x;
            *x = b->items[--end];
            b->items[end] = t;
        }
    }
    return first;
}

/* The ranges of a node's children, in the order of the items; evenly: of about equal numbers of items, so that the tree
 * does not become too deep. */
static int children_of(const build *b, range whole, bool evenly, range children[TREE_WIDTH]) {
    int count = 1;
    for (children[0] = whole, children[0].cost = 1; count < TREE_WIDTH; count++) {
        int worst = -1;
        for (int k = 0; k < count; k++) {
            bool divisible = children[k].end - children[k].first > 1;
            if (divisible && (worst < 0 || children[k].cost > children[worst].cost)) worst = k;
        }
        if (worst < 0) break;
        uint32_t middle = divide(b, children[worst], evenly);
        for (int k = count; k > worst + 1; k--) children[k] = children[k - 1];
        children[worst + 1] = (range){middle, children[worst].end, 0};
        children[worst].end = middle;
        for (int k = worst; k < worst + 2; k++) {
            bin all = bin_of_range(b, children[k].first, children[k].end);
            children[k].cost = evenly ? (double)all.count : cost_of(&all);
        }
    }
    return count;
}

/* The cone of normals: around their mean, wide enough for all; normals that count both ways are turned alike. */
static void set_cone(const build *b, range r, light_node *n, int slot, bool two_sided) {
    vec3 sum = {0, 0, 0};
    bool all_have = true;
    for (uint32_t i = r.first; i < r.end; i++) {
        const light *l = &b->lights[b->items[i].light];
        float sign = two_sided && v3_dot(sum, l->axis) < 0 ? -1.0f : 1.0f;
        if (has_normal(l)) sum = v3_madd(sum, sign * b->items[i].intensity, l->axis);
        all_have = all_have && has_normal(l);
    }
    float length = v3_length(sum), widest = 1, emits = 1;
    bool none = !all_have || !(length > 0x1p-100f);
    vec3 axis = none ? v3(0, 0, 1) : v3_scale(sum, 1.0f / length);
    for (uint32_t i = r.first; i < r.end; i++) {
        const light *l = &b->lights[b->items[i].light];
        float cosine = v3_dot(axis, l->axis);
        widest = fminf(widest, two_sided ? fabsf(cosine) : cosine);
        emits = fminf(emits, l->kind == LIGHT_SPOT ? fmaxf(-l->spot_offset / l->spot_scale, 0) : 0.0f);
    }
    widest = none ? -1.0f : fmaxf(widest - 0x1p-20f, -1.0f); /* a few roundings of what has unit length */
    n->ax[slot] = axis.x, n->ay[slot] = axis.y, n->az[slot] = axis.z;
    n->cos_o[slot] = widest;
    n->sin_o[slot] = sqrtf(fmaxf(1 - widest * widest, 0));
    n->cos_e[slot] = emits - TREE_SLACK;
}

/* The sphere about the middle of the box. Nothing is smaller than its rounding errors. */
static void set_sphere(const build *b, range r, box all, light_node *n, int slot) {
    vec3 middle = v3_scale(v3_add(all.low, all.high), 0.5f), corners[CORNERS_MAX];
    vec3 reach = upper(v3_abs(all.low), v3_abs(all.high));
    float radius2 = 0, error = 0x1p-20f * v3_max(reach);
    for (uint32_t i = r.first; i < r.end; i++)
        for (int k = corners_of(&b->lights[b->items[i].light], corners); k-- > 0;) {
            vec3 d = v3_sub(corners[k], middle);
            radius2 = fmaxf(radius2, v3_dot(d, d));
        }
    float radius = sqrtf(radius2) * (1 + 0x1p-20f) + error;
    n->x[slot] = middle.x, n->y[slot] = middle.y, n->z[slot] = middle.z;
    n->radius[slot] = fmaxf(radius, 0x1p-45f);
}

static void set_slot(const build *b, range r, light_node *n, int slot, uint32_t child) {
    bin all = bin_of_range(b, r.first, r.end);
    bool two_sided = false;
    for (uint32_t i = r.first; i < r.end; i++) two_sided |= b->lights[b->items[i].light].two_sided > 0.5f;
    set_sphere(b, r, all.box, n, slot);
    set_cone(b, r, n, slot, two_sided);
    n->intensity[slot] = fmaxf((float)all.intensity, 0x1p-100f);
    n->child[slot] = child | (two_sided ? TREE_TWO_SIDED : 0);
}

static bool new_node(build *b, uint32_t *index) {
    if (b->node_count == b->node_room) {
        uint32_t room = b->node_room ? 2 * b->node_room : 64;
        void *nodes = b->nodes;
        if (!array_resize(&nodes, room, sizeof *b->nodes)) return false;
        b->nodes = nodes;
        b->node_room = room;
    }
    *index = b->node_count++;
    b->nodes[*index] = (light_node){0};
    for (int k = 0; k < TREE_WIDTH; k++) b->nodes[*index].radius[k] = 1; /* no slot divides by 0 */
    return true;
}

/* The subtree at a level, whose trail ends there. TREE_LEVELS − level levels hold 8 to that power of lights. */
static bool build_node(build *b, range r, uint32_t level, uint64_t trail, uint32_t *index) {
    /* In the order of the random number, which goes from half to half: neighbours stay neighbours. */
    static const uint32_t slots[TREE_WIDTH] = {0, 4, 2, 6, 1, 5, 3, 7};
    range children[TREE_WIDTH];
    uint32_t below = TREE_LEVELS - 1 - level;
    bool evenly = TREE_SLOT_BITS * below < 32 && r.end - r.first > 1u << (TREE_SLOT_BITS * below);
    int count = children_of(b, r, evenly, children);
    if (!new_node(b, index)) return false;
    for (int k = 0; k < count; k++) {
        uint32_t slot = slots[k];
        uint64_t to = trail | (uint64_t)slot << (TREE_SLOT_BITS * level);
        uint32_t child;
        if (children[k].end - children[k].first == 1) {
            child = b->items[children[k].first].light;
            b->trails[child] = to;
            child |= TREE_LEAF;
        } else if (!build_node(b, children[k], level + 1, to, &child)) {
            return false;
        }
        set_slot(b, children[k], &b->nodes[*index], (int)slot, child); /* nodes may have moved */
    }
    return true;
}

static void list_items(build *b, const float *intensity, uint32_t count, double scale) {
    uint32_t placed = 0;
    for (uint32_t i = 0; i < count; i++) {
        b->trails[i] = TREE_NOWHERE;
        if (!(intensity[i] > 0)) continue;
        const light *l = &b->lights[i];
        bool one_sided = has_normal(l) && !(l->two_sided > 0.5f);
        item *to = &b->items[placed++];
        *to = (item){.intensity = (float)((double)intensity[i] * scale), .box = box_of(l), .light = i};
        if (one_sided) to->normal = v3_scale(l->axis, to->intensity);
        v3_store(to->middle, v3_scale(v3_add(to->box.low, to->box.high), 0.5f));
    }
}

light_tree *light_tree_build(kiln_arena *arena, const light *lights, const float *intensity, uint32_t count) {
    uint32_t placed = 0, root;
    double sum = 0;
    for (uint32_t i = 0; i < count; i++) placed += intensity[i] > 0, sum += (double)intensity[i];
    build b = {.lights = lights, .items = array_alloc(placed, sizeof *b.items)};
    light_tree *tree = ARENA_ARRAY(arena, light_tree, 1);
    b.trails = ARENA_ARRAY(arena, uint64_t, count);
    bool done = b.items && tree && b.trails;
    if (done) list_items(&b, intensity, count, 1 / sum);
    done = done && build_node(&b, (range){0, placed, 0}, 0, 0, &root);
    if (done) *tree = (light_tree){arena_copy(arena, b.nodes, b.node_count, sizeof *b.nodes), b.node_count, b.trails};
    done = done && tree->nodes;
    free(b.items);
    free(b.nodes);
    return done ? tree : NULL;
}
