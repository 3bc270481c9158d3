#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "image/image.h"
#include "tests/cli/run.h"

int place_open(void **state) {
    place *p = calloc(1, sizeof *p);
    strcpy(p->folder, "/tmp/kiln-cli-XXXXXX");
    strcpy(p->streams, "/tmp/kiln-cli-XXXXXX");
    *state = p;
    return !mkdtemp(p->folder) || !mkdtemp(p->streams);
}

static void empty(const char *path) {
    char name[512];
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
        if (strcmp(entry->d_name, ".") && strcmp(entry->d_name, "..") && unlink(name)) empty(name);
    }
    if (folder) closedir(folder);
    rmdir(path);
}

int place_close(void **state) {
    place *p = *state;
    empty(p->folder);
    empty(p->streams);
    free(p);
    return 0;
}

static void redirect(const char *folder, const char *name, int to) {
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (fd < 0 || dup2(fd, to) < 0) _exit(125);
}

/* In the child. */
static void become_program(const place *p, const char *const *arguments) {
    const char *argv[64] = {"kiln"};
    size_t count = 1;
    const char *input = "/dev/null", *output = NULL;
    unsetenv("OCIO");
    unsetenv("KILN_THREADS");
    for (bool environment = true; *arguments && count < 63; arguments++) {
        if (**arguments == '<') input = *arguments + 1;
        else if (**arguments == '>') output = *arguments + 1;
        else if (environment && strchr(*arguments, '=') && **arguments != '-') putenv((char *)*arguments);
        else {
            argv[count++] = *arguments;
            environment = false;
        }
    }
    if (chdir(p->folder)) _exit(125);
    redirect(p->streams, "out", STDOUT_FILENO);
    redirect(p->streams, "err", STDERR_FILENO);
    int fd = output ? open(output, O_WRONLY) : STDOUT_FILENO;
    if (fd < 0 || dup2(fd, STDOUT_FILENO) < 0) _exit(125);
    fd = open(input, O_RDONLY);
    if (fd < 0 || dup2(fd, STDIN_FILENO) < 0) _exit(125);
    execv(KILN_PROGRAM, (char *const *)argv);
    _exit(125);
}

pid_t run_start(const place *p, const char *const *arguments) {
    const char *const stale[] = {"out", "err"};
    for (int i = 0; i < 2; i++) {
        char path[128];
        snprintf(path, sizeof path, "%s/%s", p->streams, stale[i]);
        unlink(path);
    }
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) become_program(p, arguments);
    return child;
}

static unsigned char *read_all(const char *folder, const char *name, size_t *size) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "rb");
    if (!file) return NULL;
    fseek(file, 0, SEEK_END);
    long end = ftell(file);
    rewind(file);
    unsigned char *data = calloc((size_t)end + 1, 1);
    *size = fread(data, 1, (size_t)end, file);
    fclose(file);
    return data;
}

result run_wait(const place *p, pid_t child) {
    int status;
    result r;
    assert_int_equal(waitpid(child, &status, 0), child);
    r.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    r.out = (char *)read_all(p->streams, "out", &r.out_size);
    r.err = (char *)read_all(p->streams, "err", &r.err_size);
    assert_non_null(r.out);
    assert_non_null(r.err);
    return r;
}

result run_list(const place *p, const char *const *arguments) { return run_wait(p, run_start(p, arguments)); }

void result_free(result *r) {
    free(r->out);
    free(r->err);
}

bool run_says(const place *p, const char *text) {
    const struct timespec nap = {.tv_nsec = 10000000};
    for (int i = 0; i < 12000; i++) {
        size_t size;
        char *err = (char *)read_all(p->streams, "err", &size);
        bool found = err && strstr(err, text);
        free(err);
        if (found) return true;
        nanosleep(&nap, NULL);
    }
    return false;
}

static void print_run(const result *r, const char *const *arguments) {
    for (; *arguments; arguments++) print_message("%s ", *arguments);
    print_message("\nexit code %d\n%s", r->code, r->err);
}

void assert_refused_list(const place *p, int code, const char *text, const char *const *arguments) {
    size_t before = files_in(p);
    result r = run_list(p, arguments);
    const char *end = strchr(r.err, '\n');
    bool fine = r.code == code && strncmp(r.err, "error: ", 7) == 0 && end && !end[1] && strstr(r.err, text) &&
                !r.out_size && files_in(p) == before;
    if (!fine) {
        print_run(&r, arguments);
        fail_msg("expected exit code %d, one line with '%s', and nothing else", code, text);
    }
    result_free(&r);
}

void assert_runs_list(const place *p, const char *const *arguments) {
    result r = run_list(p, arguments);
    if (r.code) {
        print_run(&r, arguments);
        fail();
    }
    result_free(&r);
}

size_t files_in(const place *p) {
    size_t count = 0;
    DIR *folder = opendir(p->folder);
    for (struct dirent *entry; folder && (entry = readdir(folder));) count++;
    if (folder) closedir(folder);
    return count - 2; /* itself and its parent */
}

bool has_file(const place *p, const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", p->folder, name);
    return access(path, F_OK) == 0;
}

void write_file(const place *p, const char *name, const void *data, size_t size) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", p->folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size, file), size);
    fclose(file);
}

unsigned char *read_file(const place *p, const char *name, size_t *size) { return read_all(p->folder, name, size); }

bool same_bytes(const place *p, const char *a, const char *b) {
    size_t size_a, size_b;
    unsigned char *data_a = read_file(p, a, &size_a), *data_b = read_file(p, b, &size_b);
    bool same = data_a && data_b && size_a == size_b && memcmp(data_a, data_b, size_a) == 0;
    free(data_a);
    free(data_b);
    return same;
}

float *read_picture(const place *p, const char *name, uint32_t *width, uint32_t *height, uint32_t *channels) {
    size_t size = 0;
    kiln_image image;
    kiln_report *report = kiln_report_create();
    kiln_where where = where_root(name);
    unsigned char *bytes = read_file(p, name, &size);
    assert_non_null(bytes);
    assert_true(image_decode(bytes, size, 0, &image, &where, report));
    *width = image.width;
    *height = image.height;
    *channels = image.channels;
    size_t count = (size_t)image.width * image.height * image.channels;
    float *values = calloc(count, sizeof *values);
    for (size_t i = 0; i < count; i++)
        values[i] = image.format == KILN_PIXELS_F32  ? ((float *)image.pixels)[i]
                    : image.format == KILN_PIXELS_U8 ? ((uint8_t *)image.pixels)[i] / 255.0f
                                                     : ((uint16_t *)image.pixels)[i] / 65535.0f;
    image_free(&image);
    free(bytes);
    kiln_report_destroy(report);
    return values;
}
