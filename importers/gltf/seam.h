/* importers/gltf/seam.h: tinygltf reads the JSON of a document into plain data. */
#ifndef KILN_IMPORTERS_GLTF_SEAM_H
#define KILN_IMPORTERS_GLTF_SEAM_H

#include "base/arena.h"
#include "base/report.h"
#include "importers/gltf/document.h"

#ifdef __cplusplus
extern "C" {
#endif

/* json has been checked (json.h, schema.h) and brings no buffers and images (envelope.h): tinygltf never opens a
 * file. What the document points to lives in the arena. No exception leaves. */
bool seam_parse(const char *json, size_t size, gltf_document *, kiln_arena *, const kiln_where *file, kiln_report *);

#ifdef __cplusplus
}
#endif
#endif
