/* Shadow rays through a field that neural_shadows' ShadowField has saved: one header, C99 or C++, no
 * other library. In one source file of a program:
 *
 *     #define SHADOW_FIELD_IMPLEMENTATION
 *     #include "shadow_field.h"
 *
 *     shadow_field field;
 *     const char *problem = shadow_field_load(&field, "statue.field");
 *     if (problem) { puts(problem); exit(1); }
 *     int dark = shadow_field_occluded(&field, point, to_sun);
 *     shadow_field_free(&field);
 *
 * All places are in the mesh's own units. A loaded field is only read: threads may share it. Answers
 * are Python's, but for less than one in a thousand rays, which graze the surface; see
 * tests/unit/test_c_header.py. NaN gives 0, lit. Little-endian machines alone.
 */
#ifndef SHADOW_FIELD_H
#define SHADOW_FIELD_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    double centre[3], radius; /* of the sphere around the mesh; its cube is [-1, 1]^3 below */
    size_t size;              /* bricks along an axis of the cube */
    int32_t *grid;            /* size^3: a brick's number, or -how many a ray may skip, or SOLID */
    const int8_t *values;     /* 125 of each brick: distances to the surface, positive inside */
    const uint8_t *cells;     /* of an open sheet 8 bytes a brick: the cells it touches; else NULL */
    void *file;               /* what the last two point into */
} shadow_field;

/* NULL, or what is wrong with the file, in static memory. */
const char *shadow_field_load(shadow_field *field, const char *path);
void shadow_field_free(shadow_field *field);

/* Whether the way from a point in a direction (of any length) is blocked. */
int shadow_field_occluded(const shadow_field *field, const float point[3], const float direction[3]);

/* Whether the way from a point to another, such as a lamp's, is blocked. */
int shadow_field_blocked(const shadow_field *field, const float from[3], const float to[3]);

#ifdef __cplusplus
}
#endif
#endif

#ifdef SHADOW_FIELD_IMPLEMENTATION

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SHADOW_FIELD_FORMAT "neural_shadows.ShadowField "
#define SHADOW_FIELD_VERSION "1"

enum {
    shadow_field_CELLS = 4,             /* along a brick */
    shadow_field_VALUES = 125,          /* of a brick: its cells' corners */
    shadow_field_SAMPLES = 2,           /* of a ray, in a cell's width */
    shadow_field_SOLID = -(1 << 20)     /* in the grid: a brick within the mesh */
};

/* ---- the file: safetensors, 8 bytes of length, a JSON header, arrays ---- */

/* Where an array lies, of this type and so many bytes in all (0: any); NULL if there is none. */
static const char *shadow_field_array(
    const char *header, const char *data, size_t room, const char *name, const char *type,
    size_t bytes, size_t *found)
{
    char key[32];
    unsigned long begin, end;
    snprintf(key, sizeof key, "\"%s\":{", name);
    const char *entry = strstr(header, key);
    if (!entry) return NULL;
    const char *stop = strchr(entry, '}');
    snprintf(key, sizeof key, "\"dtype\":\"%s\"", type);
    const char *kind = strstr(entry, key), *place = strstr(entry, "\"data_offsets\":[");
    if (!stop || !kind || kind > stop || !place || place > stop) return NULL;
    if (sscanf(place, "\"data_offsets\":[%lu,%lu]", &begin, &end) != 2) return NULL;
    if (end < begin || end > room || (bytes && end - begin != bytes)) return NULL;
    *found = end - begin;
    return data + begin;
}

static char *shadow_field_read(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    char *content = NULL;
    long size;
    if (!file) return NULL;
    if (!fseek(file, 0, SEEK_END) && (size = ftell(file)) >= 0 && !fseek(file, 0, SEEK_SET)) {
        content = (char *)malloc((size_t)size + 1);
        if (content && fread(content, 1, (size_t)size, file) != (size_t)size) {
            free(content);
            content = NULL;
        }
        *length = (size_t)size;
    }
    fclose(file);
    return content;
}

static const char *shadow_field_parse(shadow_field *field, const char *content, size_t length)
{
    const char *damaged = "the file is damaged: copy or save it again";
    uint64_t header_length;
    size_t found, count, i;
    if (length < 8) return damaged;
    memcpy(&header_length, content, 8);
    if (header_length > length - 8) return damaged;
    size_t room = length - 8 - (size_t)header_length;
    const char *data = content + 8 + header_length;
    char *header = (char *)malloc((size_t)header_length + 1);
    if (!header) return "out of memory";
    memcpy(header, content + 8, (size_t)header_length);
    header[header_length] = 0;

    const char *problem = damaged;
    const char *format = strstr(header, "\"" SHADOW_FIELD_FORMAT);
    const char *centre = shadow_field_array(header, data, room, "centre", "F64", 24, &found);
    const char *radius = shadow_field_array(header, data, room, "radius", "F64", 8, &found);
    const char *grid = shadow_field_array(header, data, room, "grid", "U8", 0, &count);
    const char *values = shadow_field_array(header, data, room, "bricks", "I8", 0, &found);
    if (!format) {
        problem = "not a saved ShadowField";
    } else if (strncmp(format + strlen("\"" SHADOW_FIELD_FORMAT), SHADOW_FIELD_VERSION "\"",
                       strlen(SHADOW_FIELD_VERSION "\""))) {
        problem = "another version of the format: save the field again with this release";
    } else if (centre && radius && grid && values) {
        size_t size = (size_t)(cbrt((double)count) + 0.5), held;
        int32_t bricks = 0;
        memcpy(field->centre, centre, 24);
        memcpy(&field->radius, radius, 8);
        field->size = size;
        field->values = (const int8_t *)values;
        field->grid = (int32_t *)malloc(count * sizeof *field->grid + 1);
        for (i = 0; field->grid && i < count; i++) {
            uint8_t code = (uint8_t)grid[i];
            field->grid[i] = code == 0 ? bricks++ : code == 255 ? shadow_field_SOLID : -code;
        }
        held = (size_t)bricks;
        field->cells = (const uint8_t *)shadow_field_array(
            header, data, room, "cells", "U64", held * 8, &count);
        if (!field->grid) problem = "out of memory";
        else if (size > 0 && size * size * size == i && found == held * shadow_field_VALUES
                 && field->radius > 0 && !strstr(header, "\"cells\":") == !field->cells)
            problem = NULL;
    }
    free(header);
    return problem;
}

const char *shadow_field_load(shadow_field *field, const char *path)
{
    size_t length = 0;
    memset(field, 0, sizeof *field);
    field->file = shadow_field_read(path, &length);
    if (!field->file) return "the file cannot be read";
    const char *problem = shadow_field_parse(field, (const char *)field->file, length);
    if (problem) shadow_field_free(field);
    return problem;
}

void shadow_field_free(shadow_field *field)
{
    free(field->grid);
    free(field->file);
    memset(field, 0, sizeof *field);
}

/* ---- rays, in radii of the sphere and then in bricks from the cube's lowest corner ---- */

static int shadow_field_clamp(int i, int most) { return i < 0 ? 0 : i > most ? most : i; }

/* A brick's value at x, y, z in [0, 4], and whether the cell there has sides: a sheet touches it, or
 * it is all on one side. */
static float shadow_field_value(
    const shadow_field *field, int brick, float x, float y, float z, int *sided)
{
    int i = shadow_field_clamp((int)x, 3), j = shadow_field_clamp((int)y, 3);
    int k = shadow_field_clamp((int)z, 3);
    unsigned cell = (unsigned)(16 * i + 4 * j + k);
    const int8_t *v = field->values + (size_t)brick * shadow_field_VALUES + (i * 5 + j) * 5 + k;
    float u = x - (float)i, w = y - (float)j, t = z - (float)k;
    float a = v[0] + (v[1] - v[0]) * t, b = v[5] + (v[6] - v[5]) * t;
    float c = v[25] + (v[26] - v[25]) * t, e = v[30] + (v[31] - v[30]) * t;
    int inside = (v[0] > 0) + (v[1] > 0) + (v[5] > 0) + (v[6] > 0) + (v[25] > 0) + (v[26] > 0)
                 + (v[30] > 0) + (v[31] > 0);
    *sided = !field->cells || inside % 8 == 0
             || field->cells[(size_t)brick * 8 + cell / 8] >> cell % 8 & 1;
    a += (b - a) * w;
    c += (e - c) * w;
    return a + (c - a) * u;
}

static int32_t shadow_field_brick(const shadow_field *field, const float at[3], int brick[3])
{
    int axis;
    for (axis = 0; axis < 3; axis++)
        brick[axis] = shadow_field_clamp((int)at[axis], (int)field->size - 1);
    return field->grid[((size_t)brick[0] * field->size + (size_t)brick[1]) * field->size
                       + (size_t)brick[2]];
}

/* How far a ray goes on from a place until it leaves a brick, or `free` bricks around it. */
static float shadow_field_leave(
    const float at[3], const int brick[3], const float speed[3], const float inverse[3], int free)
{
    float least = 1e9f;
    int axis;
    for (axis = 0; axis < 3; axis++) {
        if (inverse[axis] == 0) continue;
        float end = (float)(speed[axis] > 0 ? brick[axis] + free : brick[axis] + 1 - free);
        float way = (end - at[axis]) * inverse[axis];
        if (way < least) least = way;
    }
    return least > 0 ? least : 0;
}

/* Whether the field is crossed on o + t d, 0 <= t < end: of a solid at a sample that lies inside, of
 * a sheet between two samples on either side. */
static int shadow_field_crossed(
    const shadow_field *field, const float o[3], const float d[3], float end)
{
    float scale = (float)field->size / 2, step = 1 / (scale * shadow_field_CELLS * shadow_field_SAMPLES);
    float start[3], speed[3], inverse[3], at[3], before = 0, t = 0.5f * step;
    int axis, brick[3], i = 0, last = -2, sided = 0, sided_before = 0;
    for (axis = 0; axis < 3; axis++) {
        start[axis] = (o[axis] + 1) * scale;
        speed[axis] = d[axis] * scale;
        inverse[axis] = fabsf(speed[axis]) > 1e-9f ? 1 / speed[axis] : 0;
    }
    while (t < end) {
        for (axis = 0; axis < 3; axis++) at[axis] = start[axis] + t * speed[axis];
        int32_t held = shadow_field_brick(field, at, brick);
        if (held == shadow_field_SOLID) return 1;
        float leave = t + shadow_field_leave(at, brick, speed, inverse, held < 0 ? -held : 1);
        if (held < 0) {
            int next = (int)ceilf(leave / step - 0.5f);
            i = next > i + 1 ? next : i + 1;
            t = ((float)i + 0.5f) * step;
            continue;
        }
        do {
            float in[3];
            for (axis = 0; axis < 3; axis++) {
                float x = (start[axis] + t * speed[axis] - (float)brick[axis]) * shadow_field_CELLS;
                in[axis] = fminf(fmaxf(x, 0), shadow_field_CELLS);
            }
            sided_before = sided;
            float value = shadow_field_value(field, held, in[0], in[1], in[2], &sided);
            if (!field->cells) {
                if (value > 0) return 1;
            } else if (last == i - 1 && (value > 0) != (before > 0) && sided && sided_before) {
                return 1;
            }
            before = value;
            last = i++;
            t = ((float)i + 0.5f) * step;
        } while (t < leave && t < end);
    }
    return 0;
}

/* On which side of the surface a place lies: 0, 1 within a solid or behind a sheet, or 2 for neither. */
static int shadow_field_side(const shadow_field *field, const float place[3])
{
    float at[3];
    int axis, brick[3], sided;
    for (axis = 0; axis < 3; axis++) at[axis] = (place[axis] + 1) * (float)field->size / 2;
    int32_t held = shadow_field_brick(field, at, brick);
    if (held < 0) return held == shadow_field_SOLID ? 1 : 2;
    for (axis = 0; axis < 3; axis++) at[axis] = (at[axis] - (float)brick[axis]) * shadow_field_CELLS;
    int inside = shadow_field_value(field, held, at[0], at[1], at[2], &sided) > 0;
    return sided ? inside : 2;
}

/* The part of p + t d, 0 <= t < length, that lies in the sphere: its two ends; 0 if there is none. */
static int shadow_field_clip(
    const float p[3], const float d[3], float length, float across[3], float *begin, float *end)
{
    float along = p[0] * d[0] + p[1] * d[1] + p[2] * d[2], square = 1;
    int axis;
    for (axis = 0; axis < 3; axis++) {
        /* Not |p|^2, which would cancel the digits of far points. */
        across[axis] = p[axis] - along * d[axis];
        square -= across[axis] * across[axis];
    }
    if (!(square > 0)) return 0;
    float root = sqrtf(square);
    /* In distances from the point of the ray that is next to the middle. */
    *begin = along > -root ? along : -root;
    *end = along + length < root ? along + length : root;
    return *begin < *end;
}

static void shadow_field_normalise(const shadow_field *field, const float point[3], float p[3])
{
    int axis;
    for (axis = 0; axis < 3; axis++)
        p[axis] = (float)((point[axis] - field->centre[axis]) / field->radius);
}

static int shadow_field_segment(
    const shadow_field *field, const float p[3], const float d[3], float length)
{
    float across[3], from[3], back[3], point[3], before[3], begin, end;
    float step = 2 / ((float)field->size * shadow_field_CELLS * shadow_field_SAMPLES);
    int axis;
    if (!shadow_field_clip(p, d, length, across, &begin, &end)) return 0;
    /* From the light to the point; `last` is the last sample before it. */
    float last = (ceilf((end - begin) / step - 0.5f) - 0.5f) * step;
    for (axis = 0; axis < 3; axis++) {
        from[axis] = across[axis] + end * d[axis];
        back[axis] = -d[axis];
        point[axis] = across[axis] + begin * d[axis];
        before[axis] = from[axis] + last * back[axis];
    }
    if (shadow_field_crossed(field, from, back, end - begin)) return 1;
    if (!field->cells) return shadow_field_side(field, point) == 1;
    return last > 0 && shadow_field_side(field, point) + shadow_field_side(field, before) == 1;
}

int shadow_field_occluded(const shadow_field *field, const float point[3], const float direction[3])
{
    float p[3], d[3];
    double square = 0; /* in float it may be 0 or infinite */
    int axis;
    for (axis = 0; axis < 3; axis++) square += (double)direction[axis] * direction[axis];
    for (axis = 0; axis < 3; axis++) d[axis] = (float)(direction[axis] / sqrt(square));
    shadow_field_normalise(field, point, p);
    return shadow_field_segment(field, p, d, HUGE_VALF);
}

int shadow_field_blocked(const shadow_field *field, const float from[3], const float to[3])
{
    float p[3], q[3], d[3];
    double square = 0;
    int axis;
    shadow_field_normalise(field, from, p);
    shadow_field_normalise(field, to, q);
    for (axis = 0; axis < 3; axis++) square += (double)(q[axis] - p[axis]) * (q[axis] - p[axis]);
    for (axis = 0; axis < 3; axis++) d[axis] = (float)((q[axis] - p[axis]) / sqrt(square));
    return shadow_field_segment(field, p, d, (float)sqrt(square));
}

#endif /* SHADOW_FIELD_IMPLEMENTATION */
