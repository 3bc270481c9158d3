#include "importers/gltf/json.h"

#include <string.h>

#include "base/text.h"

typedef struct scanner {
    const char *start, *at, *end;
    uint64_t values;
    const kiln_where *file;
    kiln_report *report;
} scanner;

static bool refuse(const scanner *s, const char *at, kiln_code code, const char *what) {
    size_t line = 1;
    const char *line_start = s->start;
    for (const char *c = s->start; c < at; c++)
        if (*c == '\n') {
            line++;
            line_start = c + 1;
        }
    kiln_text place = {0};
    text_format(&place, "line %zu, column %zu", line, (size_t)(at - line_start) + 1);
    kiln_where where = where_key(s->file, place.data ? place.data : "JSON");
    report_error(s->report, code, &where, "export the file again, or repair its JSON", "%s", what);
    text_free(&place);
    return false;
}

static bool refuse_syntax(const scanner *s, const char *what) {
    if (s->at >= s->end) return refuse(s, s->at, KILN_CODE_SYNTAX, "the JSON ends too early");
    return refuse(s, s->at, KILN_CODE_SYNTAX, what);
}

static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }
static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static int hex_digit(char c) {
    if (is_digit(c)) return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

static void skip_space(scanner *s) {
    while (s->at < s->end && is_space(*s->at)) s->at++;
}

static bool accept(scanner *s, char c) {
    if (s->at >= s->end || *s->at != c) return false;
    s->at++;
    return true;
}

/* The length of a well-formed UTF-8 sequence (Unicode 15, table 3-7), 0 for anything else. */
static size_t utf8_length(const unsigned char *c, size_t left) {
    if (c[0] < 0x80) return 1;
    size_t length = c[0] < 0xC2 ? 0 : c[0] < 0xE0 ? 2 : c[0] < 0xF0 ? 3 : c[0] < 0xF5 ? 4 : 0;
    if (!length || left < length) return 0;
    for (size_t i = 1; i < length; i++)
        if ((c[i] & 0xC0) != 0x80) return 0;
    bool overlong = (c[0] == 0xE0 && c[1] < 0xA0) || (c[0] == 0xF0 && c[1] < 0x90);
    bool no_scalar = (c[0] == 0xED && c[1] > 0x9F) || (c[0] == 0xF4 && c[1] > 0x8F);
    return overlong || no_scalar ? 0 : length;
}

static bool check_escape(scanner *s) {
    if (s->at < s->end && *s->at == 'u') {
        for (int i = 1; i <= 4; i++)
            if (s->end - s->at <= i || hex_digit(s->at[i]) < 0)
                return refuse_syntax(s, "\\u needs four hexadecimal digits");
        s->at += 5;
        return true;
    }
    if (s->at >= s->end || !*s->at || !strchr("\"\\/bfnrt", *s->at)) return refuse_syntax(s, "unknown escape sequence");
    s->at++;
    return true;
}

static bool check_string(scanner *s) {
    if (!accept(s, '"')) return refuse_syntax(s, "a string is expected here");
    while (s->at < s->end && *s->at != '"') {
        unsigned char c = (unsigned char)*s->at;
        if (c < 0x20) return refuse_syntax(s, "a control character inside a string");
        if (c == '\\') {
            s->at++;
            if (!check_escape(s)) return false;
            continue;
        }
        size_t length = utf8_length((const unsigned char *)s->at, (size_t)(s->end - s->at));
        if (!length) return refuse_syntax(s, "a string is not valid UTF-8");
        s->at += length;
    }
    return accept(s, '"') || refuse_syntax(s, "");
}

static bool skip_digits(scanner *s) {
    const char *first = s->at;
    while (s->at < s->end && is_digit(*s->at)) s->at++;
    return s->at > first;
}

/* Only an exponent, or hundreds of digits, can leave the range of double. */
static bool check_magnitude(const scanner *s, const char *first, bool exponent) {
    if (!exponent && s->at - first < 300) return true;
    kiln_text literal = {0};
    double value;
    text_append_bytes(&literal, first, (size_t)(s->at - first));
    bool fits = literal.data && text_to_double(literal.data, &value);
    text_free(&literal);
    return fits || refuse(s, first, KILN_CODE_RANGE, "a number that is too large");
}

static bool check_number(scanner *s) {
    const char *first = s->at;
    accept(s, '-');
    bool zero = s->at < s->end && *s->at == '0';
    if (zero) s->at++;
    else if (!skip_digits(s)) return refuse_syntax(s, "this is no JSON value (NaN and Infinity are none)");
    if (accept(s, '.') && !skip_digits(s)) return refuse_syntax(s, "digits are expected behind the decimal point");
    bool exponent = s->at < s->end && (*s->at == 'e' || *s->at == 'E');
    if (exponent) {
        s->at++;
        if (!accept(s, '+')) accept(s, '-');
        if (!skip_digits(s)) return refuse_syntax(s, "digits are expected in the exponent");
    }
    return check_magnitude(s, first, exponent);
}

static bool check_word(scanner *s, const char *word) {
    size_t length = strlen(word);
    if ((size_t)(s->end - s->at) < length || memcmp(s->at, word, length) != 0)
        return refuse_syntax(s, "this is no JSON value");
    s->at += length;
    return true;
}

/* Recursion is bounded by JSON_DEPTH_MAX. */
static bool check_value(scanner *s, int depth) {
    s->values++;
    skip_space(s);
    char c = s->at < s->end ? *s->at : '\0';
    if (c == '"') return check_string(s);
    if (c == 't') return check_word(s, "true");
    if (c == 'f') return check_word(s, "false");
    if (c == 'n') return check_word(s, "null");
    if (c != '{' && c != '[') return check_number(s);
    if (depth == JSON_DEPTH_MAX)
        return refuse(s, s->at, KILN_CODE_SYNTAX, "the JSON is nested more than 128 levels deep");
    char close = c == '{' ? '}' : ']';
    s->at++;
    skip_space(s);
    if (accept(s, close)) return true;
    for (;;) {
        skip_space(s);
        if (c == '{') {
            if (!check_string(s)) return false;
            skip_space(s);
            if (!accept(s, ':')) return refuse_syntax(s, "':' is expected here");
        }
        if (!check_value(s, depth + 1)) return false;
        skip_space(s);
        if (accept(s, close)) return true;
        if (!accept(s, ','))
            return refuse_syntax(s, c == '{' ? "',' or '}' is expected here" : "',' or ']' is expected here");
    }
}

bool json_check(const char *text, size_t size, uint64_t *value_count, const kiln_where *file, kiln_report *report) {
    scanner s = {text, text, text + size, 0, file, report};
    if (!check_value(&s, 0)) return false;
    skip_space(&s);
    *value_count = s.values;
    return s.at == s.end || refuse_syntax(&s, "something follows the end of the JSON");
}
