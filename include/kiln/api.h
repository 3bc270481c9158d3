/* kiln/api.h: what every public header needs: fixed-width types, visibility, the version.
 *
 * Unless a header says otherwise: pointers must not be NULL; what is passed in is read during the call alone; a
 * pointer that is returned is borrowed; structs of options that are all zero mean the defaults. Text is UTF-8. Objects
 * do not know of each other, nothing is global: two threads may always use two objects. */
#ifndef KILN_API_H
#define KILN_API_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define KILN_API __attribute__((visibility("default")))
#else
#define KILN_API
#endif

#define KILN_VERSION_MAJOR 0
#define KILN_VERSION_MINOR 1
#define KILN_VERSION_PATCH 0

#ifdef __cplusplus
extern "C" {
#endif

/* The library's own version, "0.1.0": may differ from the header's when the library was replaced. */
KILN_API const char *kiln_version(void);

/* A handle into a scene: 1, 2, 3, … in the order of creation; 0 stands for 'none' or 'the default'. */
typedef uint32_t kiln_id;

#ifdef __cplusplus
}
#endif
#endif
