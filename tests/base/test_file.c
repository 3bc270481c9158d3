#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"

static char folder[64];

static int make_folder(void **state) {
    (void)state;
    strcpy(folder, "/tmp/kiln-test-file.XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

/* Fails when a test leaves anything behind. */
static int remove_folder(void **state) {
    (void)state;
    return rmdir(folder);
}

static const char *in_folder(const char *name) {
    static char paths[4][128];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static void check_failure(kiln_report *report, kiln_code code, const char *where) {
    assert_int_equal(kiln_report_count(report, KILN_ERROR), 1);
    kiln_message m = kiln_report_message(report, 0);
    assert_string_equal(kiln_code_name(m.code), kiln_code_name(code));
    assert_string_equal(m.where, where);
    assert_true(m.remedy[0]);
    kiln_report_clear(report);
}

static void check_content(const char *path, const char *want, size_t size) {
    kiln_report *report = kiln_report_create();
    kiln_bytes bytes;
    assert_true(file_read(path, 1 << 20, &bytes, NULL, report));
    assert_int_equal(bytes.size, size);
    assert_memory_equal(bytes.data, want, size);
    assert_int_equal(bytes.data[size], 0); /* the byte behind the end */
    file_free(&bytes);
    assert_null(bytes.data);
    kiln_report_destroy(report);
}

static void files_come_back(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    const char *path = in_folder("a");
    assert_true(file_replace(path, "", 0, report));
    check_content(path, "", 0);
    assert_true(file_replace(path, "one\0two", 7, report));
    check_content(path, "one\0two", 7);
    struct stat status;
    mode_t mask = umask(027);
    assert_true(file_replace(path, "x", 1, report));
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640); /* as readable as any other new file */
    umask(mask);
    assert_int_equal(kiln_report_size(report), 0);
    kiln_report_destroy(report);
    unlink(path);
}

static void what_cannot_be_read(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    kiln_bytes bytes;
    kiln_where root = where_root("scene.gltf"), where = where_item(&root, "buffers", 0);
    const char *path = in_folder("a"), *fifo = in_folder("fifo");
    assert_false(file_read(path, 100, &bytes, NULL, report));
    check_failure(report, KILN_CODE_FILE_MISSING, path);
    assert_false(file_read(path, 100, &bytes, &where, report));
    check_failure(report, KILN_CODE_FILE_MISSING, "scene.gltf: buffers[0]");
    assert_false(file_read(folder, 100, &bytes, NULL, report));
    check_failure(report, KILN_CODE_FILE_UNREADABLE, folder);
    assert_false(file_read("/dev/zero", 100, &bytes, NULL, report));
    check_failure(report, KILN_CODE_FILE_UNREADABLE, "/dev/zero");
    assert_int_equal(mkfifo(fifo, 0600), 0); /* nobody writes to it: opening must not wait */
    assert_false(file_read(fifo, 100, &bytes, NULL, report));
    check_failure(report, KILN_CODE_FILE_UNREADABLE, fifo);
    unlink(fifo);
    assert_true(file_replace(path, "0123456789", 10, report));
    assert_false(file_read(path, 9, &bytes, NULL, report));
    check_failure(report, KILN_CODE_LIMIT, path);
    assert_true(file_read(path, 10, &bytes, NULL, report));
    file_free(&bytes);
    kiln_report_destroy(report);
    unlink(path);
}

/* /proc files say that they have no bytes, and have. */
static void a_file_longer_than_its_size_is_read(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    kiln_bytes bytes;
    if (access("/proc/self/status", R_OK)) skip();
    assert_true(file_read("/proc/self/status", 1 << 20, &bytes, NULL, report));
    assert_true(bytes.size > 100);
    file_free(&bytes);
    assert_false(file_read("/proc/self/status", 50, &bytes, NULL, report));
    check_failure(report, KILN_CODE_LIMIT, "/proc/self/status");
    kiln_report_destroy(report);
}

typedef struct feed {
    int fd;
    size_t size;
} feed;

static void *write_pipe(void *argument) {
    feed *f = argument;
    for (size_t i = 0; i < f->size; i++)
        if (write(f->fd, &(char){(char)(i % 251)}, 1) != 1) break;
    close(f->fd);
    return NULL;
}

static void standard_input_is_read_to_its_end(void **state) {
    (void)state;
    int ends[2], before = dup(STDIN_FILENO);
    pthread_t thread;
    assert_int_equal(pipe(ends), 0);
    feed f = {ends[1], 200000};
    dup2(ends[0], STDIN_FILENO);
    close(ends[0]);
    pthread_create(&thread, NULL, write_pipe, &f);
    kiln_report *report = kiln_report_create();
    kiln_bytes bytes;
    assert_true(file_read("-", 1 << 20, &bytes, NULL, report));
    pthread_join(thread, NULL);
    dup2(before, STDIN_FILENO);
    close(before);
    assert_int_equal(bytes.size, f.size);
    for (size_t i = 0; i < f.size; i++) assert_int_equal(bytes.data[i], i % 251);
    file_free(&bytes);
    kiln_report_destroy(report);
}

static void nothing_appears_before_the_commit(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    const char *path = in_folder("a");
    kiln_writer *writer = file_create(path, report);
    assert_true(file_write(writer, "hello", 5));
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(access(file_temporary_name(writer), F_OK), 0);
    file_discard(writer);
    assert_int_equal(access(path, F_OK), -1);
    assert_true(file_replace(path, "old", 3, report));
    writer = file_create(path, report);
    file_write(writer, "new content", 11);
    check_content(path, "old", 3);
    assert_true(file_commit(writer, report));
    check_content(path, "new content", 11);
    file_discard(NULL);
    kiln_report_destroy(report);
    unlink(path);
}

static void places_may_be_written_out_of_order(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    const char *path = in_folder("a");
    kiln_writer *writer = file_create(path, report);
    assert_true(file_write_at(writer, "world", 5, 6));
    assert_true(file_write(writer, "hello ", 6));
    assert_true(file_commit(writer, report));
    check_content(path, "hello world", 11);
    kiln_report_destroy(report);
    unlink(path);
}

static void what_cannot_be_written(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    assert_null(file_create(folder, report));
    check_failure(report, KILN_CODE_OUTPUT, folder);
    assert_null(file_create("/nonexistent/a", report));
    check_failure(report, KILN_CODE_OUTPUT, "/nonexistent/a");
    assert_null(file_create("", report));
    check_failure(report, KILN_CODE_OUTPUT, "''");
    const char *fifo = in_folder("fifo"); /* nobody reads it: opening must not wait */
    assert_int_equal(mkfifo(fifo, 0600), 0);
    assert_null(file_create(fifo, report));
    check_failure(report, KILN_CODE_OUTPUT, fifo);
    unlink(fifo);
    kiln_report_destroy(report);
}

static void *read_all(void *argument) {
    feed *f = argument;
    char bytes[64];
    for (ssize_t got; (got = read(f->fd, bytes, sizeof bytes)) > 0;) f->size += (size_t)got;
    return NULL;
}

/* A pipe or a device is written, never replaced: `-o /dev/null` by root must leave it a device. */
static void pipes_are_written_as_they_are(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    const char *fifo = in_folder("fifo");
    struct stat status;
    pthread_t thread;
    assert_int_equal(mkfifo(fifo, 0600), 0);
    feed f = {open(fifo, O_RDONLY | O_NONBLOCK), 0};
    assert_true(f.fd >= 0);
    kiln_writer *writer = file_create(fifo, report);
    assert_non_null(writer);
    fcntl(f.fd, F_SETFL, 0);
    pthread_create(&thread, NULL, read_all, &f);
    char much[100000] = {0}; /* more than a pipe holds: the writer must wait, not fail */
    assert_true(file_write(writer, much, sizeof much));
    assert_true(file_commit(writer, report));
    pthread_join(thread, NULL);
    close(f.fd);
    assert_int_equal(f.size, sizeof much);
    assert_true(lstat(fifo, &status) == 0 && S_ISFIFO(status.st_mode));
    kiln_report_destroy(report);
    unlink(fifo);
}

static void a_link_stays_a_link(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    const char *path = in_folder("a"), *link = in_folder("link");
    struct stat status;
    assert_true(file_replace(path, "old", 3, report));
    assert_int_equal(symlink("a", link), 0);
    assert_true(file_replace(link, "new", 3, report));
    assert_true(lstat(link, &status) == 0 && S_ISLNK(status.st_mode));
    check_content(path, "new", 3);
    kiln_report_destroy(report);
    unlink(link);
    unlink(path);
}

/* Stale temporaries of a process that was killed, and had the same id, are not in the way. */
static void old_temporaries_are_stepped_over(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    const char *path = in_folder("a");
    kiln_writer *first = file_create(path, report), *second = file_create(path, report);
    assert_non_null(first);
    assert_non_null(second);
    file_write(first, "first", 5);
    file_write(second, "second", 6);
    assert_true(file_commit(first, report));
    assert_true(file_commit(second, report));
    check_content(path, "second", 6);
    kiln_report_destroy(report);
    unlink(path);
}

/* What a signal handler calls: the files go, and the writers can only fail. */
static void temporaries_go_when_the_process_ends(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    kiln_writer *writers[3];
    for (int i = 0; i < 3; i++) {
        writers[i] = file_create(in_folder(i ? "b" : "a"), report);
        assert_non_null(writers[i]);
        assert_int_equal(access(file_temporary_name(writers[i]), F_OK), 0);
    }
    file_discard(writers[1]); /* its slot is empty again */
    file_remove_temporaries();
    assert_int_equal(access(file_temporary_name(writers[0]), F_OK), -1);
    assert_int_equal(access(file_temporary_name(writers[2]), F_OK), -1);
    assert_false(file_commit(writers[0], report));
    check_failure(report, KILN_CODE_OUTPUT, in_folder("a"));
    file_discard(writers[2]);
    assert_true(file_replace(in_folder("a"), "a", 1, report)); /* later ones have nothing to do with it */
    file_remove_temporaries();
    check_content(in_folder("a"), "a", 1);
    unlink(in_folder("a"));
    kiln_report_destroy(report);
}

static void files_have_an_identity(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    const char *a = in_folder("a"), *b = in_folder("b"), *link = in_folder("link");
    assert_true(file_replace(a, "a", 1, report) && file_replace(b, "a", 1, report));
    assert_int_equal(symlink("a", link), 0);
    file_identity id = file_identify(a);
    assert_true(id.known && file_same(id, file_identify(link)));
    assert_false(file_same(id, file_identify(b)));
    unlink(link);
    assert_false(file_same(file_identify(link), file_identify(link))); /* what is not there is like nothing */
    const char *const none[] = {folder, "/dev/null", in_folder("missing")};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) assert_false(file_identify(none[i]).known);
    kiln_report_destroy(report);
    unlink(b);
    unlink(a);
}

static void targets_are_one_by_folder_and_name(void **state) {
    (void)state;
    kiln_report *report = kiln_report_create();
    char here[512], there[512], detour[512];
    snprintf(here, sizeof here, "%s", in_folder("a"));
    snprintf(there, sizeof there, "%s", in_folder("b"));
    snprintf(detour, sizeof detour, "%s/./../%s", folder, strrchr(folder, '/') + 1);
    strcat(detour, "/a");
    for (int exists = 0; exists < 2; exists++) {
        assert_true(file_same_target(here, here) && file_same_target(here, detour));
        assert_false(file_same_target(here, there));
        assert_true(file_replace(here, "a", 1, report));
    }
    assert_int_equal(symlink("a", there), 0); /* writing goes through the link */
    assert_true(file_same_target(here, there));
    unlink(there);
    assert_int_equal(link(here, there), 0); /* renaming onto one name leaves the other */
    assert_false(file_same_target(here, there));
    assert_true(file_same_target("-", "-"));
    assert_false(file_same_target("-", here) || file_same_target("/dev/null", "/dev/null"));
    kiln_report_destroy(report);
    unlink(there);
    unlink(here);
}

static void paths_are_taken_apart(void **state) {
    (void)state;
    static const char *const cases[][3] = {
        {"a/b/picture.PNG", "picture.PNG", ".png"}, {"picture", "picture", ""}, {"a.b/picture", "picture", ""},
        {"a.tar.GZ", "a.tar.GZ", ".gz"},            {"dir/", "", ""},           {"", "", ""},
        {"a.averyveryverylongsuffix", "a.averyveryverylongsuffix", ""},         {".exr", ".exr", ".exr"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char suffix[16];
        path_suffix(cases[i][0], suffix);
        assert_string_equal(path_base(cases[i][0]), cases[i][1]);
        assert_string_equal(suffix, cases[i][2]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_come_back),
        cmocka_unit_test(what_cannot_be_read),
        cmocka_unit_test(a_file_longer_than_its_size_is_read),
        cmocka_unit_test(standard_input_is_read_to_its_end),
        cmocka_unit_test(nothing_appears_before_the_commit),
        cmocka_unit_test(places_may_be_written_out_of_order),
        cmocka_unit_test(what_cannot_be_written),
        cmocka_unit_test(pipes_are_written_as_they_are),
        cmocka_unit_test(a_link_stays_a_link),
        cmocka_unit_test(old_temporaries_are_stepped_over),
        cmocka_unit_test(temporaries_go_when_the_process_ends),
        cmocka_unit_test(files_have_an_identity),
        cmocka_unit_test(targets_are_one_by_folder_and_name),
        cmocka_unit_test(paths_are_taken_apart),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
