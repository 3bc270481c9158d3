#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/text.h"

static bool read_error(const char *path, const kiln_where *where, kiln_report *report, int error) {
    kiln_where here = where ? *where : where_root(path);
    if (error == ENOENT || error == ENOTDIR)
        return report_error(report, KILN_CODE_FILE_MISSING, &here, "check the path", "%s does not exist",
                            where ? path : "the file");
    return report_error(report, KILN_CODE_FILE_UNREADABLE, &here, "check the path and its permissions",
                        "%s cannot be read: %s", where ? path : "the file",
                        error == ENODEV ? "Not a regular file" : strerror(error));
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
    bool from_stdin = strcmp(path, "-") == 0;
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

struct kiln_writer {
    char *path;      /* as given, for messages */
    char *target;    /* where links lead; renamed onto */
    char *temporary; /* NULL: written as it is */
    int fd, error;
    bool to_stdout;
};

static bool write_error(const char *path, int error, kiln_report *report) {
    kiln_where here = where_root(path);
    return report_error(report, KILN_CODE_OUTPUT, &here, "check the folder, its permissions and the free space",
                        "the file cannot be written: %s", strerror(error));
}

static void free_writer(kiln_writer *writer) {
    if (writer->fd >= 0 && !writer->to_stdout) close(writer->fd);
    free(writer->path);
    free(writer->target);
    free(writer->temporary);
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
        if (writer->fd >= 0) return 0;
        if (errno != EEXIST) return errno;
    }
    return EEXIST;
}

static int open_writer(kiln_writer *writer) {
    struct stat status;
    writer->to_stdout = strcmp(writer->path, "-") == 0;
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
    *writer = (kiln_writer){.path = copy, .fd = -1};
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
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
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
