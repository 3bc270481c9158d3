#include "importers/gltf/schema.h"

/* glTF 2.0, section 5 (properties reference). */
#define INDEX SCHEMA_INDEX
#define SIZE SCHEMA_SIZE
#define NUMBER SCHEMA_NUMBER
#define STRING SCHEMA_STRING
#define BOOL SCHEMA_BOOL
#define OBJECT SCHEMA_OBJECT
#define MAP SCHEMA_MAP
#define ARRAY SCHEMA_ARRAY
#define NUMBERS(key, length) {key, ARRAY, NUMBER, {0}, length}
#define PLAIN(key, type) {key, type, 0, {0}, 0}

const schema_row schema_rows[] = {
    {"accessors", ARRAY, OBJECT, {"componentType", "count", "type"}, 0},
    PLAIN("alphaCutoff", NUMBER),
    PLAIN("alphaMode", STRING),
    {"animations", ARRAY, OBJECT, {"channels", "samplers"}, 0},
    PLAIN("aspectRatio", NUMBER),
    {"asset", OBJECT, 0, {"version"}, 0},
    PLAIN("attributes", MAP),
    NUMBERS("baseColorFactor", 4),
    {"baseColorTexture", OBJECT, 0, {"index"}, 0},
    PLAIN("buffer", INDEX),
    PLAIN("bufferView", INDEX),
    {"bufferViews", ARRAY, OBJECT, {"buffer", "byteLength"}, 0},
    {"buffers", ARRAY, OBJECT, {"byteLength"}, 0},
    PLAIN("byteLength", SIZE),
    PLAIN("byteOffset", SIZE),
    PLAIN("byteStride", INDEX),
    PLAIN("camera", INDEX),
    {"cameras", ARRAY, OBJECT, {"type"}, 0},
    {"channels", ARRAY, OBJECT, {"sampler", "target"}, 0},
    {"children", ARRAY, INDEX, {0}, 0},
    PLAIN("componentType", INDEX),
    PLAIN("count", SIZE),
    PLAIN("doubleSided", BOOL),
    NUMBERS("emissiveFactor", 3),
    {"emissiveTexture", OBJECT, 0, {"index"}, 0},
    PLAIN("extensions", SCHEMA_EXTENSIONS),
    {"extensionsRequired", ARRAY, STRING, {0}, 0},
    {"extensionsUsed", ARRAY, STRING, {0}, 0},
    {"images", ARRAY, OBJECT, {0}, 0},
    PLAIN("index", INDEX),
    {"indices", INDEX | OBJECT, 0, {"bufferView", "componentType"}, 0}, /* of a primitive; of a sparse accessor */
    PLAIN("input", INDEX),
    PLAIN("interpolation", STRING),
    PLAIN("inverseBindMatrices", INDEX),
    {"joints", ARRAY, INDEX, {0}, 0},
    PLAIN("magFilter", INDEX),
    PLAIN("material", INDEX),
    {"materials", ARRAY, OBJECT, {0}, 0},
    NUMBERS("matrix", 16),
    NUMBERS("max", 0),
    PLAIN("mesh", INDEX),
    {"meshes", ARRAY, OBJECT, {"primitives"}, 0},
    PLAIN("metallicFactor", NUMBER),
    {"metallicRoughnessTexture", OBJECT, 0, {"index"}, 0},
    PLAIN("mimeType", STRING),
    NUMBERS("min", 0),
    PLAIN("minFilter", INDEX),
    PLAIN("mode", INDEX),
    PLAIN("node", INDEX),
    {"nodes", ARRAY, INDEX | OBJECT, {0}, 0}, /* of a scene; of the file */
    {"normalTexture", OBJECT, 0, {"index"}, 0},
    PLAIN("normalized", BOOL),
    {"occlusionTexture", OBJECT, 0, {"index"}, 0},
    {"orthographic", OBJECT, 0, {"xmag", "ymag", "zfar"}, 0},
    PLAIN("output", INDEX),
    PLAIN("path", STRING),
    PLAIN("pbrMetallicRoughness", OBJECT),
    {"perspective", OBJECT, 0, {"yfov", "znear"}, 0},
    {"primitives", ARRAY, OBJECT, {"attributes"}, 0},
    NUMBERS("rotation", 4),
    PLAIN("roughnessFactor", NUMBER),
    PLAIN("sampler", INDEX),
    {"samplers", ARRAY, OBJECT, {0}, 0},
    {"scale", ARRAY | NUMBER, NUMBER, {0}, 3}, /* of a node; of a normal map */
    PLAIN("scene", INDEX),
    {"scenes", ARRAY, OBJECT, {0}, 0},
    PLAIN("skeleton", INDEX),
    PLAIN("skin", INDEX),
    {"skins", ARRAY, OBJECT, {"joints"}, 0},
    PLAIN("source", INDEX),
    {"sparse", OBJECT, 0, {"count", "indices", "values"}, 0},
    PLAIN("strength", NUMBER),
    {"target", INDEX | OBJECT, 0, {0}, 0}, /* of a buffer view; of an animation channel */
    {"targets", ARRAY, MAP, {0}, 0},
    PLAIN("texCoord", INDEX),
    {"textures", ARRAY, OBJECT, {0}, 0},
    NUMBERS("translation", 3),
    PLAIN("type", STRING),
    PLAIN("uri", STRING),
    {"values", OBJECT, 0, {"bufferView"}, 0},
    PLAIN("version", STRING),
    NUMBERS("weights", 0),
    PLAIN("wrapS", INDEX),
    PLAIN("wrapT", INDEX),
    PLAIN("xmag", NUMBER),
    PLAIN("yfov", NUMBER),
    PLAIN("ymag", NUMBER),
    PLAIN("zfar", NUMBER),
    PLAIN("znear", NUMBER),
};
const size_t schema_row_count = sizeof schema_rows / sizeof *schema_rows;
