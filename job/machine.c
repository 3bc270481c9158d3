#include "job/machine.h"

#include <jansson.h>
#if defined(__GLIBC__)
#include <malloc.h>
#endif
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "color/ocio.h"
#include "image/image.h"
#include "kiln/api.h"
#include "kiln/render.h"

uint64_t machine_memory(void) {
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    return pages > 0 && page > 0 ? (uint64_t)pages * (uint64_t)page : 0;
}

uint64_t machine_peak_memory(void) {
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (uint64_t)usage.ru_maxrss * 1024 : 0;
}

void machine_forget_peak(void) {
#if defined(__GLIBC__)
    malloc_trim(0); /* what was freed is not resident any more */
#endif
    FILE *file = fopen("/proc/self/clear_refs", "we");
    if (!file) return;
    (void)fwrite("5", 1, 1, file);
    fclose(file);
}

void machine_cpu_model(kiln_text *out) {
    FILE *file = fopen("/proc/cpuinfo", "re");
    char line[256];
    while (file && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon) continue;
        colon += 1 + strspn(colon + 1, " ");
        text_append_bytes(out, colon, strcspn(colon, "\n"));
        break;
    }
    if (file) fclose(file);
}

void machine_cpu_features(kiln_text *out) {
#if defined(__x86_64__)
    const struct { const char *name; int present; } rows[] = {
        {"sse4.2", __builtin_cpu_supports("sse4.2")},     {"avx", __builtin_cpu_supports("avx")},
        {"avx2", __builtin_cpu_supports("avx2")},         {"fma", __builtin_cpu_supports("fma")},
        {"bmi2", __builtin_cpu_supports("bmi2")},         {"avx512f", __builtin_cpu_supports("avx512f")},
        {"avx512bw", __builtin_cpu_supports("avx512bw")}, {"avx512dq", __builtin_cpu_supports("avx512dq")},
        {"avx512vl", __builtin_cpu_supports("avx512vl")}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].present) text_format(out, "%s%s", out->length ? " " : "", rows[i].name);
#else
    (void)out;
#endif
}

void machine_versions(void (*each)(void *user, const char *name, const char *version), void *user) {
    each(user, "kiln", kiln_version());
    each(user, "Embree", kiln_render_backend().embree);
    each(user, "OpenColorIO", ocio_version());
    each(user, "OpenSubdiv", KILN_OPENSUBDIV_VERSION); /* a part of its symbols' names: the library's is the same */
    each(user, "tinygltf", KILN_TINYGLTF_VERSION);     /* the package's: the library does not tell */
    image_versions(each, user);
    each(user, "jansson", jansson_version_str());
}
