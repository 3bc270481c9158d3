#include "job/json.h"

#include <stdlib.h>
#include <string.h>

json_t *json_text_of(const char *text) {
    json_t *string = json_string(text ? text : "");
    if (string) return string;
    char *ascii = strdup(text);
    for (char *c = ascii; c && *c; c++)
        if ((unsigned char)*c > 126) *c = '?';
    string = ascii ? json_string(ascii) : NULL;
    free(ascii);
    return string ? string : json_null();
}

json_t *json_numbers_of(const double *values, size_t count) {
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++) (void)json_array_append_new(array, json_number_of(values[i]));
    return array;
}

json_t *json_floats_of(const float *values, size_t count) {
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++) (void)json_array_append_new(array, json_number_of((double)values[i]));
    return array;
}
