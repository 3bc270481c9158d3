#include "importers/gltf/accessor.h"

#include <string.h>

static const char repair[] = "repair the file in the tool that wrote it";

static size_t component_bytes(int type) {
    switch (type) {
    case GLTF_BYTE:
    case GLTF_UNSIGNED_BYTE: return 1;
    case GLTF_SHORT:
    case GLTF_UNSIGNED_SHORT: return 2;
    case GLTF_UNSIGNED_INT:
    case GLTF_FLOAT: return 4;
    default: return 0;
    }
}

/* Columns of a matrix begin at multiples of 4 bytes (section 3.6.2.4: data alignment). */
static size_t column_bytes(const gltf_accessor *a) {
    size_t bytes = component_bytes(a->component_type) * a->rows;
    return a->columns > 1 ? (bytes + 3) / 4 * 4 : bytes;
}

/* count elements of `bytes`, `stride` apart, from offset on, in a view. */
static bool check_range(const gltf_reader *r, int view, size_t offset, size_t count, size_t bytes, size_t stride,
                        const kiln_where *where) {
    kiln_where view_where = where_key(where, "bufferView");
    if (!gltf_check_index(r, view, r->document.view_count, false, "buffer view", &view_where)) return false;
    size_t length = r->document.views[view].length, span;
    bool fits = size_mul(count - 1, stride, &span) && size_add(span, bytes, &span) && size_add(span, offset, &span) &&
                span <= length;
    return fits || report_error(r->report, KILN_CODE_RANGE, where, repair,
                                "%zu elements from byte %zu on reach beyond the %zu bytes of buffer view %d", count,
                                offset, length, view);
}

static void note_alignment(const gltf_reader *r, const gltf_accessor *a, const kiln_where *where) {
    size_t bytes = component_bytes(a->component_type), offset = a->offset;
    if (a->view >= 0) offset += r->document.views[a->view].offset;
    if (offset % bytes)
        report_warning(r->report, KILN_CODE_RANGE, where, NULL,
                       "the data is not aligned to the size of its components: other programs may refuse it");
}

static bool check_sparse(const gltf_reader *r, const gltf_accessor *a, const kiln_where *where) {
    kiln_where sparse = where_key(where, "sparse"), indices = where_key(&sparse, "indices"),
               values = where_key(&sparse, "values");
    const gltf_sparse *s = &a->sparse;
    if (s->count > a->count)
        return report_error(r->report, KILN_CODE_RANGE, &sparse, repair, "%zu sparse values of %zu elements", s->count,
                            a->count);
    size_t index_bytes = component_bytes(s->indices_type), element = column_bytes(a) * a->columns;
    if (s->indices_type != GLTF_UNSIGNED_BYTE && s->indices_type != GLTF_UNSIGNED_SHORT &&
        s->indices_type != GLTF_UNSIGNED_INT)
        return report_error(r->report, KILN_CODE_RANGE, &indices, repair, "%d is no component type of indices",
                            s->indices_type);
    return check_range(r, s->indices_view, s->indices_offset, s->count, index_bytes, index_bytes, &indices) &&
           check_range(r, s->values_view, s->values_offset, s->count, element, element, &values);
}

static size_t stride_of(const gltf_reader *r, const gltf_accessor *a) {
    size_t element = column_bytes(a) * a->columns;
    size_t stride = a->view >= 0 ? r->document.views[a->view].stride : 0;
    return stride ? stride : element;
}

static bool check_accessor(const gltf_reader *r, const gltf_accessor *a, const kiln_where *where) {
    if (!component_bytes(a->component_type))
        return report_error(r->report, KILN_CODE_RANGE, where, repair, "%d is no component type", a->component_type);
    if (a->count < 1) return report_error(r->report, KILN_CODE_RANGE, where, repair, "the accessor has no elements");
    kiln_where view = where_key(where, "bufferView");
    if (!gltf_check_index(r, a->view, r->document.view_count, true, "buffer view", &view)) return false;
    size_t element = column_bytes(a) * a->columns, stride = stride_of(r, a);
    if (stride < element)
        return report_error(r->report, KILN_CODE_RANGE, where, repair,
                            "elements of %zu bytes do not fit into the byteStride of %zu", element, stride);
    if (a->view >= 0 && !check_range(r, a->view, a->offset, a->count, element, stride, where)) return false;
    note_alignment(r, a, where);
    return !a->sparse.count || check_sparse(r, a, where);
}

bool accessors_check(gltf_reader *r) {
    for (size_t i = 0; i < r->document.accessor_count; i++) {
        kiln_where where = where_item(&r->file, "accessors", i);
        if (!check_accessor(r, &r->document.accessors[i], &where)) return false;
    }
    return true;
}

/* The bytes of a checked view; NULL: its buffer has none, and that was reported. */
static const unsigned char *view_bytes(const gltf_reader *r, int view, const kiln_where *where) {
    const gltf_view *v = &r->document.views[view];
    const unsigned char *data = r->buffers[v->buffer].data;
    if (data) return data + v->offset;
    report_error(r->report, KILN_CODE_REFERENCE, where, "export the asset with its data",
                 "buffer %d has neither a uri nor a binary chunk", v->buffer);
    return NULL;
}

static uint32_t load_integer(const unsigned char *at, int type) {
    uint16_t half;
    uint32_t word;
    switch (type) {
    case GLTF_UNSIGNED_BYTE: return *at;
    case GLTF_UNSIGNED_SHORT: memcpy(&half, at, 2); return half;
    default: memcpy(&word, at, 4); return word;
    }
}

static float load_float(const unsigned char *at, int type, bool normalized) {
    int8_t byte;
    int16_t half;
    float value;
    switch (type) {
    case GLTF_BYTE:
        memcpy(&byte, at, 1);
        return normalized ? (byte < -127 ? -1.0f : (float)byte / 127.0f) : (float)byte;
    case GLTF_SHORT:
        memcpy(&half, at, 2);
        return normalized ? (half < -32767 ? -1.0f : (float)half / 32767.0f) : (float)half;
    case GLTF_UNSIGNED_BYTE: return (float)*at / (normalized ? 255.0f : 1.0f);
    case GLTF_UNSIGNED_SHORT: return (float)load_integer(at, type) / (normalized ? 65535.0f : 1.0f);
    case GLTF_UNSIGNED_INT: return (float)((double)load_integer(at, type) / (normalized ? 4294967295.0 : 1.0));
    default: memcpy(&value, at, 4); return value;
    }
}

/* One element in the file to `width` numbers. */
static void load_element(const gltf_accessor *a, const unsigned char *at, uint32_t width, float *out) {
    size_t bytes = component_bytes(a->component_type), column = column_bytes(a);
    uint32_t components = accessor_width(a);
    for (uint32_t i = 0; i < width && i < components; i++)
        out[i] = load_float(at + i / a->rows * column + i % a->rows * bytes, a->component_type, a->normalized);
}

static bool is_plain(const gltf_accessor *a, uint32_t width) {
    return a->component_type == GLTF_FLOAT && a->columns == 1 && a->rows == width;
}

static bool load_floats(gltf_reader *r, const gltf_accessor *a, uint32_t width, float *out, const kiln_where *where) {
    if (a->view < 0) { /* section 3.6.2.3: zeros, for the sparse part to change */
        for (size_t i = 0; i < a->count; i++)
            for (uint32_t k = 0; k < width && k < accessor_width(a); k++) out[i * width + k] = 0;
        return true;
    }
    const unsigned char *data = view_bytes(r, a->view, where);
    if (!data) return false;
    data += a->offset;
    size_t stride = stride_of(r, a);
    if (is_plain(a, width) && stride == width * sizeof(float)) {
        memcpy(out, data, a->count * stride);
        return true;
    }
    for (size_t i = 0; i < a->count; i++) load_element(a, data + i * stride, width, out + i * width);
    return true;
}

/* Calls for the i-th sparse value with its element, which is in range. */
typedef struct sparse_reader {
    const unsigned char *indices, *values;
    size_t index_bytes, value_bytes;
} sparse_reader;

static bool open_sparse(const gltf_reader *r, const gltf_accessor *a, sparse_reader *s, const kiln_where *where) {
    s->indices = view_bytes(r, a->sparse.indices_view, where);
    s->values = s->indices ? view_bytes(r, a->sparse.values_view, where) : NULL;
    if (!s->values) return false;
    s->indices += a->sparse.indices_offset;
    s->values += a->sparse.values_offset;
    s->index_bytes = component_bytes(a->sparse.indices_type);
    s->value_bytes = column_bytes(a) * a->columns;
    for (size_t i = 0; i < a->sparse.count; i++) {
        uint32_t element = load_integer(s->indices + i * s->index_bytes, a->sparse.indices_type);
        if (element >= a->count)
            return report_error(r->report, KILN_CODE_RANGE, where, repair, "sparse value %zu is for element %u of %zu", i,
                                element, a->count);
    }
    return true;
}

bool accessor_floats(gltf_reader *r, int accessor, uint32_t width, float *out, const kiln_where *where) {
    const gltf_accessor *a = &r->document.accessors[accessor];
    sparse_reader s;
    if (!load_floats(r, a, width, out, where)) return false;
    if (!a->sparse.count) return true;
    if (!open_sparse(r, a, &s, where)) return false;
    for (size_t i = 0; i < a->sparse.count; i++) {
        size_t element = load_integer(s.indices + i * s.index_bytes, a->sparse.indices_type);
        load_element(a, s.values + i * s.value_bytes, width, out + element * width);
    }
    return true;
}

bool accessor_integers(gltf_reader *r, int accessor, uint32_t *out, const kiln_where *where) {
    const gltf_accessor *a = &r->document.accessors[accessor];
    if (a->rows != 1 || a->columns != 1 || a->normalized ||
        (a->component_type != GLTF_UNSIGNED_BYTE && a->component_type != GLTF_UNSIGNED_SHORT &&
         a->component_type != GLTF_UNSIGNED_INT))
        return report_error(r->report, KILN_CODE_RANGE, where, repair, "accessor %d does not hold unsigned integers",
                            accessor);
    const unsigned char *data = a->view < 0 ? NULL : view_bytes(r, a->view, where);
    if (a->view >= 0 && !data) return false;
    size_t stride = stride_of(r, a);
    for (size_t i = 0; i < a->count; i++)
        out[i] = data ? load_integer(data + a->offset + i * stride, a->component_type) : 0;
    if (!a->sparse.count) return true;
    sparse_reader s;
    if (!open_sparse(r, a, &s, where)) return false;
    for (size_t i = 0; i < a->sparse.count; i++)
        out[load_integer(s.indices + i * s.index_bytes, a->sparse.indices_type)] =
            load_integer(s.values + i * s.value_bytes, a->component_type);
    return true;
}
