#include <string.h>

#include "image/codec.h"

void image_caption(const kiln_image_write_options *options, kiln_text *out) {
    for (uint32_t i = 0; i < options->text_count; i++)
        text_format(out, "%s%s: %s", i ? "\n" : "", options->text[2 * i], options->text[2 * i + 1]);
}

/* XML 1.0 has names for what would be markup, and no place at all for most control characters. */
static void append_escaped(kiln_text *out, const char *text) {
    for (; *text; text++) {
        unsigned char c = (unsigned char)*text;
        if (c == '<') text_append(out, "&lt;");
        else if (c == '>') text_append(out, "&gt;");
        else if (c == '&') text_append(out, "&amp;");
        else if (c == '"') text_append(out, "&quot;");
        else text_append_bytes(out, c < 0x20 && c != '\n' ? " " : text, 1);
    }
}

static const char *value_of(const kiln_image_write_options *options, const char *keyword) {
    for (uint32_t i = 0; i < options->text_count; i++)
        if (strcmp(options->text[2 * i], keyword) == 0) return options->text[2 * i + 1];
    return "";
}

/* ISO 16684-1. The xpacket's id is the standard's; end="r": not to be edited in place, so there is no padding. */
void image_xmp(const kiln_image_write_options *options, kiln_text *out) {
    if (!options->text_count) return;
    kiln_text lines = {0};
    image_caption(options, &lines);
    text_append(out, "<?xpacket begin=\"\xef\xbb\xbf\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n"
                     "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">"
                     "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">"
                     "<rdf:Description rdf:about=\"\" xmlns:dc=\"http://purl.org/dc/elements/1.1/\" "
                     "xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\" xmp:CreatorTool=\"");
    append_escaped(out, value_of(options, "Software"));
    text_append(out, "\"><dc:description><rdf:Alt><rdf:li xml:lang=\"x-default\">");
    append_escaped(out, lines.data ? lines.data : "");
    text_append(out, "</rdf:li></rdf:Alt></dc:description></rdf:Description></rdf:RDF></x:xmpmeta>\n"
                     "<?xpacket end=\"r\"?>");
    out->failed |= lines.failed;
    text_free(&lines);
}
