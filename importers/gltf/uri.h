/* importers/gltf/uri.h: where a URI of a glTF file leads: nowhere but into the folder of the asset, unless allowed. */
#ifndef KILN_IMPORTERS_GLTF_URI_H
#define KILN_IMPORTERS_GLTF_URI_H

#include "base/file.h"

/* The file that a relative URI (percent-encoded UTF-8) names, with every symbolic link resolved, when it exists and
 * lies inside folder, or anywhere with allow_outside, which takes absolute paths too; free(). folder NULL: the asset
 * came from standard input and has none. NULL: an error was added. */
char *uri_resolve(const char *uri, const char *folder, bool allow_outside, const kiln_where *, kiln_report *);

/* Does it begin with "data:"? */
bool uri_is_data(const char *uri, size_t length);

/* The bytes of a data URI (RFC 2397), base64 or percent-encoded, whatever media type it names; file_free(). */
bool uri_decode_data(const char *uri, size_t length, kiln_bytes *, const kiln_where *, kiln_report *);

#endif
