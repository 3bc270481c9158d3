#include "importers/gltf/gltf.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "importers/gltf/extensions.h"
#include "importers/gltf/json.h"
#include "importers/gltf/reader.h"
#include "importers/gltf/schema.h"
#include "importers/gltf/seam.h"

/* What tinygltf and the document keep for one value of JSON, with nlohmann's tree beside it: the worst is a short
 * number in extras (measured: 190 bytes on Debian 12). */
enum { PARSED_VALUE_BYTES = 256 };

bool reader_reserve(gltf_reader *r, uint64_t bytes, const kiln_where *where) {
    if (bytes > r->budget)
        return report_error(r->report, KILN_CODE_LIMIT, where, "raise the memory limit, or split the asset",
                            "%llu bytes more than the memory limit allows", (unsigned long long)(bytes - r->budget));
    r->budget -= bytes;
    return true;
}

void *reader_array(gltf_reader *r, size_t count, size_t size, const kiln_where *where) {
    size_t bytes;
    if (!size_mul(count, size, &bytes)) bytes = SIZE_MAX;
    if (!reader_reserve(r, bytes, where)) return NULL;
    void *array = arena_array(&r->arena, count, size);
    if (!array) report_no_memory(r->report, "reading a glTF file");
    return array;
}

static uint64_t default_budget(void) {
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    return pages > 0 && page > 0 ? (uint64_t)pages * (uint64_t)page / 4 * 3 : (uint64_t)8 << 30;
}

/* For those who ask what the file is. */
static bool keep_source(gltf_reader *r, json_value root) {
    scene_source *source = &r->scene->source;
    source->format = "glTF 2.0";
    envelope_read_asset(root, &r->scene->arena, &source->generator, &source->copyright);
    return extensions_note(&r->envelope, root, &r->scene->arena, source, &r->file, r->report) && buffers_list_files(r);
}

static bool parse_document(gltf_reader *r) {
    const gltf_container *c = &r->container;
    uint64_t values;
    if (!json_check(c->json, c->json_size, &values, &r->file, r->report)) return false;
    json_value root = json_root(c->json);
    if (!envelope_check_version(root, &r->arena, &r->file, r->report) || !schema_check(root, &r->file, r->report) ||
        !envelope_read(root, &r->envelope, &r->arena, &r->file, r->report) ||
        !extensions_check(&r->envelope, &r->arena, &r->file, r->report) || !keep_source(r, root))
        return false;
    uint64_t parser_bytes = values * PARSED_VALUE_BYTES + c->json_size;
    if (!reader_reserve(r, parser_bytes, &r->file)) return false;
    size_t size;
    char *json = envelope_strip(&r->envelope, c->json, c->json_size, &size);
    if (!json) return report_no_memory(r->report, "reading a glTF file");
    bool parsed = seam_parse(json, size, &r->document, &r->arena, &r->file, r->report);
    free(json);
    r->budget += parser_bytes;
    return parsed;
}

static bool make_tables(gltf_reader *r) {
    r->images = reader_array(r, r->envelope.images.count, sizeof *r->images, &r->file);
    r->materials = reader_array(r, r->document.material_count, sizeof *r->materials, &r->file);
    r->meshes = reader_array(r, r->document.mesh_count, sizeof *r->meshes, &r->file);
    return r->images && r->materials && r->meshes;
}

/* Each kind of motion that the file has and a still picture leaves out. */
static void note_motion(const gltf_reader *r) {
    const gltf_document *d = &r->document;
    kiln_where animations = where_item(&r->file, "animations", 0), skins = where_item(&r->file, "skins", 0);
    if (d->animation_count)
        report_warning(r->report, KILN_CODE_IGNORED, &animations, NULL, "%zu animation%s left out: the scene is at rest",
                       d->animation_count, d->animation_count == 1 ? " is" : "s are");
    if (d->skin_count)
        report_warning(r->report, KILN_CODE_IGNORED, &skins, NULL, "%zu skin%s left out: meshes are shown unposed",
                       d->skin_count, d->skin_count == 1 ? " is" : "s are");
    size_t morphed = 0, first_mesh = 0, first_primitive = 0;
    for (size_t m = d->mesh_count; m-- > 0;)
        for (size_t p = d->meshes[m].primitive_count; p-- > 0;) {
            if (!d->meshes[m].primitives[p].target_count) continue;
            morphed++;
            first_mesh = m;
            first_primitive = p;
        }
    kiln_where mesh = where_item(&r->file, "meshes", first_mesh),
               targets = where_item(&mesh, "primitives", first_primitive);
    if (morphed)
        report_warning(r->report, KILN_CODE_IGNORED, &targets, NULL,
                       "morph targets of %zu primitive%s are left out: meshes have their base shape", morphed,
                       morphed == 1 ? "" : "s");
}

static bool build_scene(gltf_reader *r) {
    bool built = make_tables(r) && gltf_check_document(r) && gltf_place_nodes(r) && gltf_add_materials(r) &&
                 gltf_add_meshes(r) && gltf_add_instances(r);
    if (built) gltf_link_nodes(r);
    return built;
}

static bool read_all(gltf_reader *r) {
    const kiln_bytes *bytes = blob_bytes(r->bytes);
    if (!container_open(bytes->data, bytes->size, &r->container, &r->file, r->report) || !parse_document(r) ||
        !buffers_load(r))
        return false;
    note_motion(r);
    scene_locate(r->scene, &r->file);
    bool built = build_scene(r);
    scene_locate(r->scene, NULL);
    if (built && !r->scene->instance_count)
        report_warning(r->report, KILN_CODE_GEOMETRY, &r->file, "is the right scene of the file the default one?",
                       "the scene has no surfaces: there is nothing to see");
    return built;
}

/* Takes the bytes over. */
static bool import_bytes(gltf_reader *r, kiln_bytes *bytes) {
    size_t size = bytes->size;
    r->bytes = blob_create(bytes);
    bool done = r->bytes ? reader_reserve(r, size, &r->file) && read_all(r)
                         : report_no_memory(r->report, "reading a file");
    buffers_free(r);
    blob_release(r->bytes);
    arena_free(&r->arena);
    return done;
}

static uint64_t budget_of(const kiln_import_options *options) {
    return options && options->memory_limit ? options->memory_limit : default_budget();
}

bool gltf_import_memory(const char *name, const void *bytes, size_t size, const char *folder,
                        const kiln_import_options *options, kiln_scene *scene, kiln_report *report) {
    gltf_reader r = {.folder = folder, .allow_outside = options && options->allow_outside, .file = where_root(name),
                     .report = report, .budget = budget_of(options), .scene = scene};
    kiln_bytes copy = {malloc(size + 1), size};
    if (!copy.data) return report_no_memory(report, "reading a glTF file");
    memcpy(copy.data, bytes, size);
    copy.data[size] = 0;
    return import_bytes(&r, &copy);
}

bool gltf_import(const char *path, const kiln_import_options *options, kiln_scene *scene, kiln_report *report) {
    bool from_stdin = strcmp(path, "-") == 0;
    gltf_reader r = {.path = path, .allow_outside = options && options->allow_outside,
                     .file = where_root(from_stdin ? "standard input" : path), .report = report,
                     .budget = budget_of(options), .scene = scene};
    kiln_bytes bytes;
    if (!file_read(path, r.budget, &bytes, NULL, report)) return false;
    char *folder = from_stdin ? NULL : strndup(path, (size_t)(path_base(path) - path));
    if (!from_stdin && !folder) {
        file_free(&bytes);
        return report_no_memory(report, "reading a glTF file");
    }
    r.folder = folder;
    bool done = import_bytes(&r, &bytes);
    free(folder);
    return done;
}
