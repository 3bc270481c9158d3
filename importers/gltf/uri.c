#include "importers/gltf/uri.h"

#include <ctype.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/text.h"

static const char refer[] = "refer to a file beside the asset by a relative path",
                  allow[] = "put the file beside the asset, or trust the asset with --allow-outside",
                  pack[] = "pack the files into the glb, or give the asset by its path";

static int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    c = (char)tolower((unsigned char)c);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* A '%' without two digits stands for itself, as careless exporters mean it. Returns the length; no terminator. */
static size_t percent_decode(const char *in, size_t length, char *out) {
    size_t n = 0;
    for (size_t i = 0; i < length; i++) {
        bool escape = in[i] == '%' && length - i > 2 && hex_digit(in[i + 1]) >= 0 && hex_digit(in[i + 2]) >= 0;
        out[n++] = escape ? (char)(hex_digit(in[i + 1]) * 16 + hex_digit(in[i + 2])) : in[i];
        if (escape) i += 2;
    }
    return n;
}

/* RFC 3986, section 3.1: letters, digits, '+', '-', '.' up to a colon; a drive letter looks the same. */
static bool has_scheme(const char *uri) {
    if (!isalpha((unsigned char)*uri)) return false;
    while (isalnum((unsigned char)*uri) || *uri == '+' || *uri == '-' || *uri == '.') uri++;
    return *uri == ':';
}

/* Does the path climb above where it starts, whether or not the folders exist? */
static bool climbs(const char *path) {
    int depth = 0;
    for (const char *at = path; *at;) {
        size_t length = strcspn(at, "/\\");
        if (length == 2 && at[0] == '.' && at[1] == '.') depth--;
        else if (length > 0 && !(length == 1 && at[0] == '.')) depth++;
        if (depth < 0) return true;
        at += length + (at[length] != '\0');
    }
    return false;
}

static bool refuse(const kiln_where *where, kiln_report *report, const char *remedy, const char *why,
                   const char *uri) {
    return report_error(report, KILN_CODE_PATH_OUTSIDE, where, remedy, "%s: %.200s", why, uri);
}

static bool check_path(const char *path, size_t length, const char *folder, bool allow_outside,
                       const kiln_where *where, kiln_report *report) {
    if (strlen(path) != length) return refuse(where, report, refer, "a URI with a zero byte in it", path);
    if (length == 0) return report_error(report, KILN_CODE_REFERENCE, where, refer, "the URI is empty");
    if (has_scheme(path)) return refuse(where, report, refer, "kiln opens paths alone, no other scheme", path);
    if (!folder) return refuse(where, report, pack, "a glb on standard input has no folder to find files in", path);
    if (allow_outside) return true;
    if (path[0] == '/' || path[0] == '\\')
        return refuse(where, report, allow, "an absolute path leaves the asset's folder", path);
    return !climbs(path) || refuse(where, report, allow, "the URI leaves the asset's folder", path);
}

static char *join(const char *folder, const char *path) {
    kiln_text text = {0};
    if (*path != '/') text_format(&text, "%s/", folder);
    text_append(&text, path);
    return text_take(&text);
}

/* realpath of folder/path; writers on Windows leave backslashes, tried when nothing has that name. */
static char *find_file(const char *folder, const char *path) {
    char *name = join(folder, path);
    char *real = name ? realpath(name, NULL) : NULL;
    if (!real && name && errno == ENOENT && strchr(path, '\\')) {
        for (char *c = name + strlen(name) - strlen(path); *c; c++)
            if (*c == '\\') *c = '/';
        real = realpath(name, NULL);
    }
    int error = errno;
    free(name);
    errno = error;
    return real;
}

static bool lies_inside(const char *file, const char *folder) {
    size_t length = strlen(folder);
    if (length == 1) return true; /* "/" */
    return strncmp(file, folder, length) == 0 && (file[length] == '/' || file[length] == '\0');
}

char *uri_resolve(const char *uri, const char *folder, bool allow_outside, const kiln_where *where,
                  kiln_report *report) {
    size_t length = strlen(uri);
    char *path = malloc(length + 1);
    if (!path) {
        report_no_memory(report, "resolving a URI");
        return NULL;
    }
    size_t decoded = percent_decode(uri, length, path);
    path[decoded] = '\0';
    char *real_folder = NULL, *file = NULL;
    if (check_path(path, decoded, folder, allow_outside, where, report)) {
        real_folder = realpath(*folder ? folder : ".", NULL);
        file = real_folder ? find_file(real_folder, path) : NULL;
        if (!file && (errno == ENOENT || errno == ENOTDIR))
            report_error(report, KILN_CODE_FILE_MISSING, where, "put the file there, or export the asset with its data",
                         "%.200s does not exist", path);
        else if (!file)
            report_error(report, KILN_CODE_FILE_UNREADABLE, where, "check the path and its permissions",
                         "%.200s cannot be read: %s", path, strerror(errno));
        else if (!allow_outside && !lies_inside(file, real_folder)) {
            refuse(where, report, allow, "a symbolic link leaves the asset's folder", path);
            free(file);
            file = NULL;
        }
    }
    free(real_folder);
    free(path);
    return file;
}

bool uri_is_data(const char *uri, size_t length) { return length >= 5 && strncasecmp(uri, "data:", 5) == 0; }

static int base64_digit(unsigned char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/* out has room for length / 4 * 3 + 3. Missing padding is fine. Returns false at the first stranger. */
static bool base64_decode(const char *in, size_t length, unsigned char *out, size_t *size) {
    while (length && in[length - 1] == '=') length--;
    uint32_t bits = 0;
    size_t n = 0;
    for (size_t i = 0; i < length; i++) {
        int digit = base64_digit((unsigned char)in[i]);
        if (digit < 0) return false;
        bits = bits << 6 | (uint32_t)digit;
        if (i % 4 == 0) continue;
        out[n++] = (unsigned char)(bits >> (6 - 2 * (i % 4)));
    }
    *size = n;
    return length % 4 != 1;
}

bool uri_decode_data(const char *uri, size_t length, kiln_bytes *bytes, const kiln_where *where, kiln_report *report) {
    *bytes = (kiln_bytes){0};
    const char *comma = memchr(uri, ',', length);
    if (!comma)
        return report_error(report, KILN_CODE_SYNTAX, where, "export the file again", "a data URI without a comma");
    const char *data = comma + 1;
    size_t data_length = length - (size_t)(data - uri);
    bool base64 = comma - uri >= 7 && strncasecmp(comma - 7, ";base64", 7) == 0;
    unsigned char *out = malloc(base64 ? data_length / 4 * 3 + 4 : data_length + 1);
    if (!out) return report_no_memory(report, "decoding a data URI");
    size_t size = 0;
    if (!base64) size = percent_decode(data, data_length, (char *)out);
    else if (!base64_decode(data, data_length, out, &size)) {
        free(out);
        return report_error(report, KILN_CODE_SYNTAX, where, "export the file again", "a data URI that is not valid base64");
    }
    out[size] = 0;
    *bytes = (kiln_bytes){out, size};
    return true;
}
