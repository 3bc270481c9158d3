#include "job/effects.h"

#include <string.h>

static const char *caller_kind(kiln_effect_caller_kind kind) {
    static const char *const names[] = {[KILN_CALLED_BY_MATERIAL] = "material", [KILN_CALLED_BY_MESH] = "mesh",
                                        [KILN_CALLED_BY_INSTANCE] = "instance", [KILN_CALLED_BY_LIGHT] = "light",
                                        [KILN_CALLED_BY_CAMERA] = "camera",
                                        [KILN_CALLED_BY_ENVIRONMENT] = "environment"};
    return names[kind];
}

static json_t *caller(const kiln_effect_caller *c) {
    json_t *o = json_object();
    put_text(o, "kind", caller_kind(c->kind));
    put(o, "index", c->id ? json_integer(c->id - 1) : json_null()); /* in the list of its kind */
    put_text(o, "name", c->name);
    return o;
}

static json_t *row(const kiln_effect_plan *plan, kiln_effect effect) {
    const kiln_effect_use *use = &plan->uses[effect];
    kiln_effect_facts facts = kiln_effect_describe(effect);
    json_t *o = json_object(), *callers = json_array();
    put_text(o, "name", facts.name);
    put_bool(o, "called", use->called);
    put_bool(o, "removable", facts.removable);
    put_bool(o, "runs", use->runs);
    put_count(o, "caller_count", use->caller_count);
    for (uint32_t i = 0; i < use->caller_count && i < KILN_EFFECT_CALLERS; i++)
        (void)json_array_append_new(callers, caller(&use->callers[i]));
    put(o, "callers", callers);
    put_text(o, "called_for_by", facts.called_for_by);
    put_text(o, "stages", facts.stages);
    put_text(o, "terms", facts.terms);
    put_text(o, "embree", facts.embree);
    put_text(o, "samples", facts.samples);
    put_count(o, "bytes", use->bytes);
    return o;
}

json_t *effects_facts(const kiln_effect_plan *plan) {
    json_t *array = json_array();
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) (void)json_array_append_new(array, row(plan, (kiln_effect)e));
    return array;
}

void effects_list(uint64_t effects, kiln_text *out) {
    const char *before = "";
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) {
        if (!(effects >> e & 1)) continue;
        text_format(out, "%s%s", before, kiln_effect_describe((kiln_effect)e).name);
        before = ", ";
    }
    if (!*before) text_append(out, "none");
}

static bool refuse(const char *name, kiln_text *problem) {
    const char *names[KILN_EFFECT_COUNT];
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) names[e] = kiln_effect_describe((kiln_effect)e).name;
    const char *nearest = text_nearest(name, names, KILN_EFFECT_COUNT);
    text_format(problem, "there is no effect '%s'", name);
    if (nearest) text_format(problem, " (did you mean '%s'?)", nearest);
    text_append(problem, "; there are ");
    effects_list(KILN_EFFECT_BIT(KILN_EFFECT_COUNT) - 1, problem);
    return false;
}

/* "-name" or "+name", or a word that may stand first. */
static bool parse_item(const char *item, bool first, kiln_effects *wish, kiln_text *problem) {
    kiln_effect effect;
    if (first && strcmp(item, "auto") == 0) return true;
    if (first && strcmp(item, "all") == 0) return wish->all = true;
    if (*item != '-' && *item != '+') {
        text_format(problem, "'%s' begins neither with '-', which drops an effect, nor with '+', which adds one", item);
        return false;
    }
    if (!kiln_effect_find(item + 1, &effect)) return refuse(item + 1, problem);
    if (*item == '-' && !kiln_effect_describe(effect).removable) {
        text_format(problem, "a scene cannot be shown without '%s'", item + 1);
        return false;
    }
    *(*item == '-' ? &wish->removed : &wish->forced) |= KILN_EFFECT_BIT(effect);
    return true;
}

bool effects_parse(const char *text, kiln_effects *wish, kiln_text *problem) {
    bool done = true;
    *wish = (kiln_effects){0};
    for (bool first = true; done; first = false) {
        char item[64];
        size_t length = strcspn(text, ",");
        if (length >= sizeof item) {
            text_format(problem, "'%s' is no list of effects", text);
            return false;
        }
        memcpy(item, text, length);
        item[length] = '\0';
        done = parse_item(item, first, wish, problem);
        if (!text[length]) break;
        text += length + 1;
    }
    if (done && wish->removed & wish->forced) {
        text_append(problem, "an effect cannot be dropped and added: ");
        effects_list(wish->removed & wish->forced, problem);
        return false;
    }
    return done;
}

void effects_print(const kiln_effects *wish, kiln_text *out) {
    text_append(out, wish->all ? "all" : "auto");
    for (int e = 0; e < KILN_EFFECT_COUNT; e++) {
        const char *name = kiln_effect_describe((kiln_effect)e).name;
        if (wish->removed >> e & 1) text_format(out, ",-%s", name);
        if (wish->forced >> e & 1) text_format(out, ",+%s", name);
    }
}
