/* Which libraries read and write the pictures. */
#include <openexr.h>
#include <png.h>
#include <stdio.h> /* jpeglib.h needs it */
#include <stdlib.h>
#include <string.h>
#include <tiffio.h>
#include <webp/encode.h>

#include <jpeglib.h>

#include "image/image.h"

#define TEXT_OF_(x) #x
#define TEXT_OF(x) TEXT_OF_(x)

void image_versions(void (*each)(void *user, const char *name, const char *version), void *user) {
    char text[64];
    int major, minor, patch, webp = WebPGetEncoderVersion();
    const char *extra;
    exr_get_library_version(&major, &minor, &patch, &extra);
    snprintf(text, sizeof text, "%d.%d.%d", major, minor, patch);
    each(user, "OpenEXR", text);
    each(user, "libpng", png_get_libpng_ver(NULL));
    each(user, "libjpeg-turbo", TEXT_OF(LIBJPEG_TURBO_VERSION)); /* the header's: the library does not tell */
    snprintf(text, sizeof text, "%d.%d.%d", webp >> 16 & 255, webp >> 8 & 255, webp & 255);
    each(user, "libwebp", text);
    const char *tiff = TIFFGetVersion(); /* "LIBTIFF, Version 4.5.0\nCopyright …" */
    const char *number = strpbrk(tiff, "0123456789");
    snprintf(text, sizeof text, "%.*s", number ? (int)strspn(number, "0123456789.") : 0, number ? number : "");
    each(user, "libtiff", text);
}
