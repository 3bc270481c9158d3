#include "importers/gltf/json.h"

#include <string.h>

json_kind json_kind_of(const char *at) {
    switch (*at) {
    case '{': return JSON_OBJECT;
    case '[': return JSON_ARRAY;
    case '"': return JSON_STRING;
    case 't':
    case 'f': return JSON_BOOL;
    case 'n': return JSON_NULL;
    default: return JSON_NUMBER;
    }
}

const char *json_kind_name(json_kind kind) {
    static const char *const names[] = {[JSON_NULL] = "null",        [JSON_BOOL] = "a boolean",
                                        [JSON_NUMBER] = "a number",  [JSON_STRING] = "a string",
                                        [JSON_ARRAY] = "an array",   [JSON_OBJECT] = "an object"};
    return names[kind];
}

const char *json_space(const char *at) {
    while (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t') at++;
    return at;
}

static const char *skip_string(const char *at) {
    for (at++; *at != '"'; at++)
        if (*at == '\\') at++;
    return at + 1;
}

/* Of numbers and words. */
static bool is_literal(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || c == '-' || c == '+' || c == '.' || c == 'E';
}

const char *json_skip(const char *at) {
    size_t depth = 0;
    do {
        switch (*at) {
        case '"': at = skip_string(at); break;
        case '{':
        case '[':
            depth++;
            at++;
            break;
        case '}':
        case ']':
            depth--;
            at++;
            break;
        case ',':
        case ':': at++; break;
        default:
            while (is_literal(*at)) at++;
        }
        if (depth) at = json_space(at);
    } while (depth);
    return at;
}

json_value json_root(const char *text) {
    const char *at = json_space(text);
    return (json_value){at, json_skip(at)};
}

json_cursor json_open(json_value container) {
    json_kind kind = json_kind_of(container.at);
    json_cursor cursor = {container.at + 1, kind == JSON_OBJECT, kind != JSON_OBJECT && kind != JSON_ARRAY};
    if (!cursor.done) cursor.at = json_space(cursor.at);
    if (!cursor.done && (*cursor.at == ']' || *cursor.at == '}')) cursor.done = true;
    return cursor;
}

bool json_next(json_cursor *cursor, json_value *key, json_value *value) {
    if (cursor->done) return false;
    const char *at = cursor->at;
    if (cursor->object) {
        const char *behind = skip_string(at);
        if (key) *key = (json_value){at, behind};
        at = json_space(json_space(behind) + 1);
    }
    *value = (json_value){at, json_skip(at)};
    at = json_space(value->end);
    cursor->done = *at != ',';
    cursor->at = cursor->done ? at : json_space(at + 1);
    return true;
}

bool json_is(json_value string, const char *name) {
    size_t length = strlen(name);
    return (size_t)(string.end - string.at) == length + 2 && memcmp(string.at + 1, name, length) == 0;
}

bool json_member(json_value object, const char *name, json_value *value) {
    if (json_kind_of(object.at) != JSON_OBJECT) return false;
    json_value key;
    json_cursor cursor = json_open(object);
    while (json_next(&cursor, &key, value))
        if (json_is(key, name)) return true;
    return false;
}

static unsigned hex_digit(char c) { return (unsigned)(c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10); }
static unsigned hex4(const char *at) {
    return hex_digit(at[0]) << 12 | hex_digit(at[1]) << 8 | hex_digit(at[2]) << 4 | hex_digit(at[3]);
}

static char *put_utf8(char *out, unsigned code) {
    if (code < 0x80) {
        *out++ = (char)code;
        return out;
    }
    int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    static const unsigned lead[] = {0, 0xC0, 0xE0, 0xF0};
    *out++ = (char)(lead[more] | code >> (6 * more));
    while (more--) *out++ = (char)(0x80 | (code >> (6 * more) & 0x3F));
    return out;
}

/* at: the first digit of \uXXXX. A surrogate without its partner becomes U+FFFD. */
static const char *decode_unicode(const char *at, char **out) {
    unsigned code = hex4(at);
    at += 4;
    bool high = code >= 0xD800 && code < 0xDC00;
    if (high && at[0] == '\\' && at[1] == 'u') {
        unsigned low = hex4(at + 2);
        if (low >= 0xDC00 && low < 0xE000) {
            code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
            at += 6;
        }
    }
    if (code >= 0xD800 && code < 0xE000) code = 0xFFFD;
    *out = put_utf8(*out, code);
    return at;
}

char *json_text(json_value string, kiln_arena *arena) {
    size_t size = (size_t)(string.end - string.at); /* no escape is shorter than what it stands for */
    char *text = ARENA_ARRAY(arena, char, size + 1), *out = text;
    if (!text) return NULL;
    for (const char *at = string.at + 1; at < string.end - 1;) {
        if (*at != '\\') {
            *out++ = *at++;
            continue;
        }
        static const char from[] = "\"\\/bfnrt", to[] = "\"\\/\b\f\n\r\t";
        char escape = at[1];
        at += 2;
        if (escape == 'u') at = decode_unicode(at, &out);
        else *out++ = to[strchr(from, escape) - from];
    }
    *out = '\0';
    return text;
}

bool json_whole(json_value number, uint64_t *value) {
    *value = 0;
    for (const char *at = number.at; at < number.end; at++) {
        if (*at < '0' || *at > '9') return false;
        *value = 10 * *value + (uint64_t)(*at - '0');
        if (*value > (uint64_t)1 << 53) return false;
    }
    return true;
}
