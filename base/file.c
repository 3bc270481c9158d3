#include "base/file.h"

#include <ctype.h>
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
                        "%s cannot be read: %s", where ? path : "the file", strerror(error));
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
    if (!error && !from_stdin && !S_ISREG(status.st_mode)) error = EINVAL;
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
    char *path, *temporary;
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
    free(writer->temporary);
    free(writer);
}

kiln_writer *file_create(const char *path, kiln_report *report) {
    kiln_writer *writer = calloc(1, sizeof *writer);
    kiln_text temporary = {0};
    text_format(&temporary, "%s.XXXXXX", path);
    char *name = text_take(&temporary), *copy = strdup(path);
    if (!writer || !name || !copy) {
        free(writer);
        free(name);
        free(copy);
        report_no_memory(report, "opening an output file");
        return NULL;
    }
    *writer = (kiln_writer){copy, name, -1, 0, strcmp(path, "-") == 0};
    struct stat status;
    int error = 0;
    if (writer->to_stdout) writer->fd = STDOUT_FILENO;
    else if (stat(path, &status) == 0 && S_ISDIR(status.st_mode)) error = EISDIR;
    else if ((writer->fd = mkstemp(name)) < 0) error = errno;
    if (error) {
        write_error(path, error, report);
        free_writer(writer);
        return NULL;
    }
    /* mkstemp makes files private; an output is as readable as any other new file. */
    if (!writer->to_stdout) {
        mode_t mask = umask(0);
        umask(mask);
        (void)fchmod(writer->fd, 0666 & ~mask);
    }
    return writer;
}

const char *file_temporary_name(const kiln_writer *writer) { return writer->temporary; }

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
    if (!writer->to_stdout) {
        if (!error && fsync(writer->fd)) error = errno;
        if (!error && rename(writer->temporary, writer->path)) error = errno;
        if (error) (void)unlink(writer->temporary);
        else flush_folder(writer->path);
    }
    bool done = error ? write_error(writer->path, error, report) : true;
    free_writer(writer);
    return done;
}

void file_discard(kiln_writer *writer) {
    if (!writer) return;
    if (!writer->to_stdout) (void)unlink(writer->temporary);
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
        for (; dot[length]; length++) suffix[length] = (char)tolower((unsigned char)dot[length]);
    suffix[length] = '\0';
}
