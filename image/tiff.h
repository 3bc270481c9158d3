/* image/tiff.h: libtiff on memory, for tiff.c and tiff_write.c. */
#ifndef KILN_IMAGE_TIFF_H
#define KILN_IMAGE_TIFF_H

#include <stdbool.h>
#include <stdint.h>

#include <tiffio.h>

typedef struct image_tiff_stream {
    unsigned char *bytes;
    uint64_t size, at, capacity;
    bool writable; /* bytes are malloc's, and grow */
    char message[256]; /* the first error */
} image_tiff_stream;

/* mode as of TIFFOpen; no single allocation far above limit bytes (0: none). NULL: the message says why. */
TIFF *image_tiff_open(image_tiff_stream *, const char *mode, uint64_t limit);

#endif
