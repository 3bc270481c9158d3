#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/text.h"

/* Messages call the streams by name; "-" would be looked for as a file. */
static bool is_stream(const char *path) { return strcmp(path, "-") == 0; }

static bool read_error(const char *path, const kiln_where *where, kiln_report *report, int error) {
    const char *reason = error == ENODEV ? "Not a regular file" : strerror(error);
    if (is_stream(path)) {
        kiln_where here = where_root("standard input");
        return report_error(report, KILN_CODE_FILE_UNREADABLE, &here, "send a file into it: < car.glb",
                            "it cannot be read: %s", reason);
    }
    kiln_where here = where ? *where : where_root(*path ? path : "''");
    const char *subject = where && where->parent ? path : "the file"; /* else the place is the file's name */
    if (error == ENOENT || error == ENOTDIR)
        return report_error(report, KILN_CODE_FILE_MISSING, &here, "check the path", "%s does not exist", subject);
    return report_error(report, KILN_CODE_FILE_UNREADABLE, &here, "check the path and its permissions",
                        "%s cannot be read: %s", subject, reason);
}

static bool too_large(const char *path, uint64_t limit, const kiln_where *where, kiln_report *report) {
    kiln_where here = where ? *where : where_root(path);
    return report_error(report, KILN_CODE_LIMIT, &here, "split the file or raise the memory limit",
                        "the file is larger than the limit of %llu bytes", (unsigned long long)limit);
}

/* Reads until the end: a pipe has no size, and a file may grow. */
static int read_all(int fd, uint64_t limit, size_t expected, kiln_bytes *bytes) {
    size_t capacity = expected + 1, size = 0;
    unsigned char *data = malloc(capacity + 1);
    if (!data) return ENOMEM;
    for (;;) {
        ssize_t got = read(fd, data + size, capacity - size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            int error = errno;
            free(data);
            return error;
        }
        size += (size_t)got;
        if (size > limit) {
            free(data);
            return EFBIG;
        }
        if (got == 0) break;
        if (size < capacity) continue;
        capacity += capacity / 2 + 65536;
        unsigned char *larger = realloc(data, capacity + 1);
        if (!larger) {
            free(data);
            return ENOMEM;
        }
        data = larger;
    }
    data[size] = 0;
    *bytes = (kiln_bytes){data, size};
    return 0;
}

bool file_read(const char *path, uint64_t limit, kiln_bytes *bytes, const kiln_where *where, kiln_report *report) {
    *bytes = (kiln_bytes){0};
    bool from_stdin = is_stream(path);
    /* O_NONBLOCK: opening a FIFO that nobody writes must not hang; the kind is checked next. */
    int fd = from_stdin ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return read_error(path, where, report, errno);
    struct stat status;
    int error = fstat(fd, &status) ? errno : 0;
    if (!error && !from_stdin && S_ISDIR(status.st_mode)) error = EISDIR;
    if (!error && !from_stdin && !S_ISREG(status.st_mode)) error = ENODEV;
    size_t expected = !error && S_ISREG(status.st_mode) ? (size_t)status.st_size : 65536;
    if (!error && expected > limit) error = EFBIG;
    if (!error) error = read_all(fd, limit, expected, bytes);
    if (!from_stdin) close(fd);
    if (error == EFBIG) return too_large(path, limit, where, report);
    return error ? read_error(path, where, report, error) : true;
}

void file_free(kiln_bytes *bytes) {
    free(bytes->data);
    *bytes = (kiln_bytes){0};
}

file_identity file_identify(const char *path) {
    struct stat status;
    bool exists = (is_stream(path) ? fstat(STDIN_FILENO, &status) : stat(path, &status)) == 0;
    if (!exists || !S_ISREG(status.st_mode)) return (file_identity){0};
    uint64_t changed = (uint64_t)status.st_mtim.tv_sec * 1000000000u + (uint64_t)status.st_mtim.tv_nsec;
    return (file_identity){true, (uint64_t)status.st_dev, (uint64_t)status.st_ino, (uint64_t)status.st_size, changed};
}

/* The folder that a name lies in, "." for a bare one; free(). */
static char *folder_of(const char *path) {
    const char *base = path_base(path);
    return base > path ? strndup(path, (size_t)(base - path)) : strdup(".");
}

static bool same_folder(const char *a, const char *b) {
    char *folder_a = folder_of(a), *folder_b = folder_of(b);
    struct stat status_a, status_b;
    bool same = folder_a && folder_b && stat(folder_a, &status_a) == 0 && stat(folder_b, &status_b) == 0 &&
                status_a.st_dev == status_b.st_dev && status_a.st_ino == status_b.st_ino;
    free(folder_a);
    free(folder_b);
    return same;
}

bool file_same_target(const char *a, const char *b) {
    struct stat status;
    if (is_stream(a) || is_stream(b)) return is_stream(a) && is_stream(b);
    const char *const paths[] = {a, b};
    for (int i = 0; i < 2; i++)
        if (stat(paths[i], &status) == 0 && !S_ISREG(status.st_mode)) return false; /* written as it is */
    char *real_a = realpath(a, NULL), *real_b = realpath(b, NULL); /* NULL: it is not there yet */
    const char *target_a = real_a ? real_a : a, *target_b = real_b ? real_b : b;
    bool same = strcmp(path_base(target_a), path_base(target_b)) == 0 && same_folder(target_a, target_b);
    free(real_a);
    free(real_b);
    return same;
}

struct kiln_writer {
    char *path;      /* as given, for messages */
    char *target;    /* where links lead; renamed onto */
    char *temporary; /* NULL: written as it is */
    int fd, error;
    int slot; /* of the temporary, in temporaries */
    bool to_stdout;
};

/* The names of temporaries: a signal handler has no writer that it could ask, and signals come to the process, so this
 * is the process's too. Who takes a name out of its slot owns it; what a handler took is not given back. */
enum { TEMPORARIES_MAX = 64, NO_SLOT = -1 };
static _Atomic(char *) temporaries[TEMPORARIES_MAX];
static char *volatile taken[TEMPORARIES_MAX]; /* by a handler: still in sight of those who look for leaks */
_Static_assert(ATOMIC_POINTER_LOCK_FREE == 2, "a signal handler reads the table");

/* NO_SLOT: all are taken, and this one is left behind when the process is ended. */
static int list_temporary(char *name) {
    for (int slot = 0; slot < TEMPORARIES_MAX; slot++) {
        char *empty = NULL;
        if (atomic_compare_exchange_strong(&temporaries[slot], &empty, name)) return slot;
    }
    return NO_SLOT;
}

static void free_temporary(kiln_writer *writer) {
    char *name = writer->temporary;
    if (writer->slot == NO_SLOT || atomic_compare_exchange_strong(&temporaries[writer->slot], &name, NULL))
        free(writer->temporary);
}

void file_remove_temporaries(void) {
    for (int slot = 0; slot < TEMPORARIES_MAX; slot++) {
        char *name = atomic_exchange(&temporaries[slot], NULL);
        if (!name) continue;
        (void)unlink(name);
        taken[slot] = name;
    }
}

static bool write_error(const char *path, int error, kiln_report *report) {
    bool stream = is_stream(path);
    kiln_where here = where_root(stream ? "standard output" : *path ? path : "''");
    const char *remedy = stream           ? "check what it leads to"
                         : error == EFBIG ? "raise the limit of file sizes (ulimit -f), or write less"
                                          : "check the folder, its permissions and the free space";
    return report_error(report, KILN_CODE_OUTPUT, &here, remedy, "%s cannot be written: %s",
                        stream ? "it" : "the file", strerror(error));
}

static void free_writer(kiln_writer *writer) {
    if (writer->fd >= 0 && !writer->to_stdout) close(writer->fd);
    free_temporary(writer);
    free(writer->path);
    free(writer->target);
    free(writer);
}

/* A new file beside the target. mkstemp would make it private, and the umask cannot be asked for without being changed
 * under other threads' feet. */
static int open_temporary(kiln_writer *writer) {
    for (unsigned attempt = 0; attempt < 1000; attempt++) {
        kiln_text name = {0};
        text_format(&name, "%s.%lx-%u", writer->target, (unsigned long)getpid(), attempt);
        free(writer->temporary);
        writer->temporary = text_take(&name);
        if (!writer->temporary) return ENOMEM;
        writer->fd = open(writer->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (writer->fd >= 0) {
            writer->slot = list_temporary(writer->temporary);
            return 0;
        }
        if (errno != EEXIST) return errno;
    }
    return EEXIST;
}

static int open_writer(kiln_writer *writer) {
    struct stat status;
    writer->to_stdout = is_stream(writer->path);
    if (writer->to_stdout) {
        writer->fd = STDOUT_FILENO;
        return 0;
    }
    if (!writer->path[0]) return ENOENT; /* else only the rename would fail */
    bool exists = stat(writer->path, &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) return EISDIR;
    if (exists && !S_ISREG(status.st_mode)) { /* renaming onto a device would replace it for everyone */
        /* O_NONBLOCK: opening a FIFO that nobody reads must not hang. */
        writer->fd = open(writer->path, O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
        return writer->fd < 0 || fcntl(writer->fd, F_SETFL, 0) < 0 ? errno : 0;
    }
    writer->target = exists ? realpath(writer->path, NULL) : strdup(writer->path);
    return writer->target ? open_temporary(writer) : errno;
}

kiln_writer *file_create(const char *path, kiln_report *report) {
    kiln_writer *writer = calloc(1, sizeof *writer);
    char *copy = strdup(path);
    if (!writer || !copy) {
        free(writer);
        free(copy);
        report_no_memory(report, "opening an output file");
        return NULL;
    }
    *writer = (kiln_writer){.path = copy, .fd = -1, .slot = NO_SLOT};
    int error = open_writer(writer);
    if (!error) return writer;
    write_error(path, error, report);
    free_writer(writer);
    return NULL;
}

const char *file_temporary_name(const kiln_writer *writer) {
    return writer->to_stdout ? NULL : writer->temporary ? writer->temporary : writer->path;
}

bool file_write(kiln_writer *writer, const void *data, size_t size) {
    const char *at = data;
    while (size > 0 && !writer->error) {
        ssize_t put = write(writer->fd, at, size);
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) writer->error = errno;
        else {
            at += put;
            size -= (size_t)put;
        }
    }
    return !writer->error;
}

bool file_write_at(kiln_writer *writer, const void *data, size_t size, uint64_t offset) {
    const char *at = data;
    while (size > 0 && !writer->error) {
        ssize_t put = pwrite(writer->fd, at, size, (off_t)offset);
        if (put < 0 && errno == EINTR) continue;
        if (put < 0) writer->error = errno;
        else {
            at += put;
            offset += (uint64_t)put;
            size -= (size_t)put;
        }
    }
    return !writer->error;
}

/* The rename itself must reach the disk too. */
static void flush_folder(const char *path) {
    char *folder = folder_of(path);
    int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    if (fd >= 0) {
        (void)fsync(fd);
        close(fd);
    }
    free(folder);
}

bool file_commit(kiln_writer *writer, kiln_report *report) {
    int error = writer->error;
    if (writer->temporary) {
        if (!error && fsync(writer->fd)) error = errno;
        if (!error && rename(writer->temporary, writer->target)) error = errno;
        if (error) (void)unlink(writer->temporary);
        else flush_folder(writer->target);
    }
    bool done = error ? write_error(writer->path, error, report) : true;
    free_writer(writer);
    return done;
}

void file_discard(kiln_writer *writer) {
    if (!writer) return;
    if (writer->temporary) (void)unlink(writer->temporary);
    free_writer(writer);
}

bool file_replace(const char *path, const void *data, size_t size, kiln_report *report) {
    kiln_writer *writer = file_create(path, report);
    if (!writer) return false;
    file_write(writer, data, size);
    return file_commit(writer, report);
}

const char *path_base(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

void path_suffix(const char *path, char suffix[16]) {
    const char *dot = strrchr(path_base(path), '.');
    size_t length = 0;
    if (dot && strlen(dot) < 16)
        for (; dot[length]; length++) /* not tolower, whose answer depends on the locale */
            suffix[length] = dot[length] >= 'A' && dot[length] <= 'Z' ? (char)(dot[length] - 'A' + 'a') : dot[length];
    suffix[length] = '\0';
}
