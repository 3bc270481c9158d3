/* base/file.h: whole files in, whole files or nothing out. */
#ifndef KILN_BASE_FILE_H
#define KILN_BASE_FILE_H

#include "base/report.h"

/* Bytes of a file; data has one zero byte behind the end. Free with file_free. */
typedef struct kiln_bytes {
    unsigned char *data;
    size_t size;
} kiln_bytes;

/* Reads path, or standard input for "-". Directories, devices and files above limit bytes are refused. where may be
 * NULL: then the path itself is the place; standard input is always its own. */
bool file_read(const char *path, uint64_t limit, kiln_bytes *bytes, const kiln_where *where, kiln_report *report);
void file_free(kiln_bytes *bytes);

/* Which file a path leads to, whatever it is called: equal for links to one file. */
typedef struct file_identity {
    bool known; /* it is a regular file that exists */
    uint64_t device, inode;
    uint64_t size, changed; /* bytes; nanoseconds since 1970: another content is another pair, as good as always */
} file_identity;
file_identity file_identify(const char *path); /* "-": of standard input */
static inline bool file_same(file_identity a, file_identity b) {
    return a.known && b.known && a.device == b.device && a.inode == b.inode;
}
/* Whether writing to the one path would replace what was written to the other: the same name in the same folder, links
 * followed, or standard output ("-") twice. Devices and pipes take any number of writers. */
bool file_same_target(const char *a, const char *b);

/* A file that appears under its name whole or not at all: written to a temporary beside it, flushed to the disk,
 * renamed. A link stays a link, to the new file. "-" is standard output; that, devices and pipes are written as they
 * are. */
typedef struct kiln_writer kiln_writer;
kiln_writer *file_create(const char *path, kiln_report *report); /* NULL: reported */
/* Where to write before file_commit: a name to hand to a library that opens files itself. NULL for standard output. */
const char *file_temporary_name(const kiln_writer *);
bool file_write(kiln_writer *, const void *data, size_t size);
/* At a place counted from the start, without moving where file_write goes on. A pipe fails. */
bool file_write_at(kiln_writer *, const void *data, size_t size, uint64_t offset);
/* Renames into place; false: reported, and nothing is left behind. Frees the writer either way. */
bool file_commit(kiln_writer *, kiln_report *report);
void file_discard(kiln_writer *); /* removes the temporary; NULL is fine */

/* Removes the temporaries of all writers that are open, which can only fail from then on: for a process that ends at
 * once. May be called from a signal handler. */
void file_remove_temporaries(void);

/* write(path, data) in one go. */
bool file_replace(const char *path, const void *data, size_t size, kiln_report *report);

/* The part of path after the last '/', and its suffix with the dot, lower-cased into a buffer; "" when none. */
const char *path_base(const char *path);
void path_suffix(const char *path, char suffix[16]);

#endif
