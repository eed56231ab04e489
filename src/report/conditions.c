/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report/conditions.h"

#include "core/array.h"
#include "core/memory_stream.h"

#include <stdlib.h>
#include <string.h>

static bool same(const cp_condition *condition, const char *text, const char *own)
{
    return strcmp(condition->text, text) == 0 && (condition->own != NULL) == (own != NULL);
}

// "aeb" or "0.1 to 2 (aeb)", behind what stands there already; NULL when memory is short.
static char *lengthened(const char *of, const char *treatment, const char *own)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = cp_memory_stream(&text, &size);
    if (!out)
        return NULL;
    if (of)
        fprintf(out, "%s, ", of);
    if (own)
        fprintf(out, "%s (%s)", own, treatment);
    else
        fputs(treatment, out);
    if (fclose(out) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

static cp_condition *append(cp_conditions *c, const char *text, const char *own)
{
    cp_condition *condition = cp_array_add(c->condition, c->count);
    if (!condition)
        return NULL;
    *condition = (cp_condition){.text = strdup(text), .own = own ? strdup(own) : NULL};
    if (!condition->text || (own && !condition->own)) {
        free(condition->text);
        free(condition->own);
        c->count--;
        return NULL;
    }
    return condition;
}

void cp_conditions_add(cp_conditions *c, const char *treatment, const char *text, const char *own)
{
    cp_condition *condition = NULL;
    for (size_t k = 0; text && k < c->count; k++)
        if (same(&c->condition[k], text, own))
            condition = &c->condition[k];
    if (text && !condition)
        condition = append(c, text, own);
    char *of = condition ? lengthened(condition->of, treatment, own) : NULL;
    c->failed |= !of;
    if (!of)
        return;
    free(condition->of);
    condition->of = of;
    condition->treatments++;
}

void cp_conditions_write(FILE *out, const cp_conditions *c, size_t treatments)
{
    for (size_t k = 0; k < c->count; k++) {
        const cp_condition *condition = &c->condition[k];
        if (condition->own)
            fprintf(out, "%s %s. ", condition->text,
                    treatments == 1 ? condition->own : condition->of);
        else if (condition->treatments == treatments)
            fprintf(out, "%s. ", condition->text);
        else
            fprintf(out, "%s: %s. ", condition->of, condition->text);
    }
}

void cp_conditions_destroy(cp_conditions *c)
{
    for (size_t k = 0; k < c->count; k++) {
        free(c->condition[k].text);
        free(c->condition[k].own);
        free(c->condition[k].of);
    }
    free(c->condition);
    *c = (cp_conditions){0};
}

bool cp_condition_begin(cp_condition_draft *d, cp_conditions *c)
{
    *d = (cp_condition_draft){0};
    d->out = cp_memory_stream(&d->text, &d->size);
    c->failed |= !d->out;
    return d->out != NULL;
}

void cp_condition_end(cp_condition_draft *d, cp_conditions *c, const char *treatment,
                      const char *stem)
{
    if (fclose(d->out) != 0)
        c->failed = true;
    else if (*d->text)
        cp_conditions_add(c, treatment, stem ? stem : d->text, stem ? d->text : NULL);
    free(d->text);
}
