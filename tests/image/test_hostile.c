/* Cut and damaged files of every format: each decodes, or is refused with one located error. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <fcntl.h>

#include "seeds.h"

/* A limit that the seeds are far below, so that a damaged size cannot take seconds to fill. */
static const uint64_t LIMIT = 16 << 20;
enum { FLIPS = 2500 };

/* In memory of exactly its size, so that a sanitizer sees reads behind the end. */
static bool decode_copy(const unsigned char *bytes, size_t size, kiln_image *image) {
    unsigned char *copy = malloc(size ? size : 1);
    kiln_code code;
    memcpy(copy, bytes, size);
    bool done = decode(copy, size, LIMIT, image, &code);
    free(copy);
    return done;
}

static void try_copy(const unsigned char *bytes, size_t size) {
    kiln_image image;
    if (decode_copy(bytes, size, &image)) image_free(&image);
}

/* A cut file is refused, unless only what follows the pixels is missing (the end of a PNG, the profile of a TIFF):
 * then the picture is whole. */
static void every_prefix(void **state) {
    (void)state;
    for (int i = 0; i < SEED_COUNT; i++) {
        kiln_bytes file = seed_make(i);
        kiln_image whole = decode_well(file.data, file.size), image;
        for (size_t size = 0; size <= file.size; size++) {
            if (!decode_copy(file.data, size, &image)) continue;
            if (memcmp(image.pixels, whole.pixels, image_bytes(&whole)))
                fail_msg("%s: %d of %d bytes give another picture", seed_name(i), (int)size, (int)file.size);
            image_free(&image);
        }
        image_free(&whole);
        file_free(&file);
    }
}

/* Bytes changed at random places, from one to eight of them: to noise, to extremes, or by one bit. */
static void damage(unsigned char *bytes, size_t size, uint32_t n) {
    uint32_t count = 1 + hash_pair(n, 0) % 8;
    for (uint32_t k = 1; k <= count; k++) {
        uint32_t h = hash_triple(n, k, 1), reach = h & 1 ? (uint32_t)size : (uint32_t)(size < 400 ? size : 400);
        size_t at = hash_triple(n, k, 2) % reach; /* half of them where headers are */
        switch (h >> 1 & 3) {
        case 0: bytes[at] ^= (unsigned char)(1u << (h >> 8 & 7)); break;
        case 1: bytes[at] = h & 16 ? 0xff : 0; break;
        case 2: bytes[at] = (unsigned char)(bytes[at] + 1); break;
        default: bytes[at] = (unsigned char)(h >> 16);
        }
    }
}

static void damaged_bytes(void **state) {
    (void)state;
    for (int i = 0; i < SEED_COUNT; i++) {
        kiln_bytes file = seed_make(i);
        unsigned char *copy = malloc(file.size);
        for (uint32_t n = 0; n < FLIPS; n++) {
            memcpy(copy, file.data, file.size);
            damage(copy, file.size, hash_pair((uint32_t)i, n));
            try_copy(copy, file.size);
        }
        free(copy);
        file_free(&file);
    }
}

/* One format's magic before another's body, and noise behind every magic. */
static void wrong_bodies(void **state) {
    (void)state;
    for (int i = 0; i < SEED_COUNT; i++) {
        kiln_bytes file = seed_make(i);
        for (uint32_t n = 0; n < 50; n++) {
            unsigned char noise[512];
            for (uint32_t k = 0; k < sizeof noise; k++) noise[k] = (unsigned char)hash_triple((uint32_t)i, n, k);
            size_t keep = 4 + n % 40;
            memcpy(noise, file.data, keep);
            try_copy(noise, sizeof noise);
        }
        file_free(&file);
    }
}

/* The libraries must not talk: standard error stays empty through all of the above. */
static void nothing_is_printed(void **state) {
    (void)state;
    folder f = folder_make("stderr");
    int before = dup(STDERR_FILENO), file = open(f.file, O_RDWR | O_CREAT, 0600);
    fflush(stderr);
    dup2(file, STDERR_FILENO);
    for (int i = 0; i < SEED_COUNT; i++) {
        kiln_bytes seed = seed_make(i);
        for (size_t size = 0; size < seed.size; size += 1 + seed.size / 50) try_copy(seed.data, size);
        for (uint32_t n = 0; n < 200; n++) {
            unsigned char *copy = malloc(seed.size);
            memcpy(copy, seed.data, seed.size);
            damage(copy, seed.size, hash_pair((uint32_t)i, n));
            try_copy(copy, seed.size);
            free(copy);
        }
        file_free(&seed);
    }
    fflush(stderr);
    dup2(before, STDERR_FILENO);
    close(before);
    long size = lseek(file, 0, SEEK_END);
    close(file);
    folder_remove(&f);
    assert_int_equal(size, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_prefix),
        cmocka_unit_test(damaged_bytes),
        cmocka_unit_test(wrong_bodies),
        cmocka_unit_test(nothing_is_printed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
