/* Occlusion of points by a field under one light: the loop of field_occlusion.py, in stages of many
   points each, and with the same answers to the bit.

   Most stages are plain loops over short arrays, which a compiler turns into vector instructions
   where the machine has them; the one that it does not is written for AVX2 and without. Structures
   mirror those of compiled_occlusion.py, where arrays are described. Compile without contracting
   products and sums, and with integers that wrap: far outside the box positions are beyond 2^31. */

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#ifdef __AVX2__
#include <immintrin.h>
#endif

/* Of cell_words.py, field_bricks.py and light_tables.py. */
enum { CELL = 20, BRICK = CELL + 2, NODE = BRICK + 2, PART = 12 };
enum { OUTSIDE, INSIDE, VOID };
enum { FIRST = 13, DOUBLED = 13, DARK = 16 };

enum {
    BLOCK = 512,        /* points of a stage */
    EARLY = 8,          /* samples of a ray before its others are listed: most need no more */
    FURTHER = 24,       /* and before all others */
    SAMPLES = 8192,     /* listed before they are looked up */
    MOST = 4096,        /* samples of a ray */
    ROOM = SAMPLES + MOST + 64,
};

typedef struct {
    int32_t sheet, density, columns, layers, shape[3], row_bytes, word_bytes;
    float scale, shift[3]; /* from points to blocks of the box */
    const uint32_t *nodes;
    const void *rows;
    const uint64_t *masks;
    const uint32_t *first;
    const void *words;
} Field;

typedef struct {
    int32_t merged, axes[3], back, near, deep, rows, low[2], middle[2];
    double source[3];
    const int32_t *offsets, *ends;
    const uint32_t *ranges;
    const uint64_t *slabs;
} Light;

/* Rays that the tables do not decide. Positions are in 2^-CELL cells: sample k of a ray is at
   start + k step. */
typedef struct {
    int32_t count;
    int32_t point[BLOCK], tile[BLOCK], planes[BLOCK];
    float depth[BLOCK], u[BLOCK], v[BLOCK], slope_a[BLOCK], slope_b[BLOCK];
    int32_t start[3][BLOCK], step[3][BLOCK], end[3][BLOCK];
    uint8_t within[BLOCK]; /* the end, in the box without its outermost bricks, which are empty */
} Rays;

/* Positions to look up, and numbers and words of those in crossed cells. */
typedef struct {
    int32_t count;
    int32_t at[3][ROOM], point[ROOM], node[ROOM], inner[ROOM], crossed[ROOM], word[ROOM];
    uint8_t state[ROOM];
} Samples;

typedef struct {
    Rays rays;
    Samples samples;
    int32_t listed[BLOCK], later[BLOCK]; /* samples of each ray; rays with more */
} Work;

typedef int32_t Eight __attribute__((vector_size(32), aligned(4)));
static const Eight NUMBERS = {0, 1, 2, 3, 4, 5, 6, 7};

/* A length in 2^-CELL cells, of which `unit` are 1. */
static inline int32_t fixed(float length, float unit) {
    return (int32_t)floorf(length * unit + 0.5f);
}

/* Planes of samples of a slab. */
static inline int32_t per_slab(const Light *light, const Field *field) {
    return field->density << light->merged;
}

static inline int32_t least(int32_t a, int32_t b) { return a < b ? a : b; }
static inline int32_t most(int32_t a, int32_t b) { return a > b ? a : b; }

/* Mark the points whose tiles are dark, and keep those that they leave open. */
static void decide(const Light *light, const Field *field, const float *points, int32_t n,
                   float bias, Rays *rays, uint8_t *occlusion) {
    float position[3][BLOCK], depth[BLOCK], u[BLOCK], v[BLOCK], slope_a[BLOCK], slope_b[BLOCK];
    int32_t row[BLOCK], column[BLOCK], tile[BLOCK];
    uint32_t range[BLOCK];
    uint8_t open[BLOCK];
    const int m = light->axes[0], a = light->axes[1], b = light->axes[2];
    const float scale = field->scale, far = (float)light->deep, rows = (float)light->rows;
    const float scale_m = light->back ? -scale : scale;
    const float shift_m = light->back ? far - field->shift[m] : field->shift[m];
    const float shift_a = field->shift[a] - (float)light->low[0];
    const float shift_b = field->shift[b] - (float)light->low[1];
    for (int32_t i = 0; i < n; i++) {
        position[0][i] = points[3 * i];
        position[1][i] = points[3 * i + 1];
        position[2][i] = points[3 * i + 2];
    }
    const float *p_m = position[m], *p_a = position[a], *p_b = position[b];
    if (light->near) {
        const float light_m = (float)light->source[0], reach = far - light_m;
        const float light_a = (float)(light->source[1] - light->low[0]);
        const float light_b = (float)(light->source[2] - light->low[1]);
        for (int32_t i = 0; i < n; i++) {
            const float z = p_m[i] * scale_m + shift_m, beyond = z - light_m;
            const float at_a = p_a[i] * scale + shift_a, from_a = at_a - light_a;
            const float at_b = p_b[i] * scale + shift_b, from_b = at_b - light_b;
            const int here = (beyond > 0) & (beyond < INFINITY) & (fabsf(from_a) <= beyond) &
                             (fabsf(from_b) <= beyond);
            /* From the closer end on: from far away rays round to tiles of other slopes, in which
               their samples leave the box. */
            const int of_light = z - far > reach;
            const float left = of_light ? reach : far - z;
            slope_a[i] = from_a / beyond;
            slope_b[i] = from_b / beyond;
            u[i] = here ? (of_light ? light_a : at_a) + slope_a[i] * left : -1;
            v[i] = (of_light ? light_b : at_b) + slope_b[i] * left;
            depth[i] = z;
        }
    } else {
        const float along_a = (float)light->source[1], along_b = (float)light->source[2];
        for (int32_t i = 0; i < n; i++) {
            const float z = p_m[i] * scale_m + shift_m;
            u[i] = p_a[i] * scale + shift_a + along_a * (far - z);
            v[i] = p_b[i] * scale + shift_b + along_b * (far - z);
            slope_a[i] = along_a;
            slope_b[i] = along_b;
            depth[i] = z;
        }
    }
    for (int32_t i = 0; i < n; i++) {
        /* Not for NaN; beyond 2^16 there are no tiles. */
        const int here = (u[i] >= 0) & (u[i] < rows) & (v[i] >= 0) & (v[i] < 65536);
        row[i] = (int32_t)(here ? u[i] : 0);
        column[i] = (int32_t)(here ? v[i] : 65536);
    }
    const int32_t none = light->ends[light->rows];
    for (int32_t i = 0; i < n; i++) {
        const int32_t t = light->offsets[row[i]] + column[i];
        tile[i] = (t >= light->ends[row[i]]) & (t < light->ends[row[i] + 1]) ? t : none;
        range[i] = light->ranges[tile[i]];
    }
    for (int32_t i = 0; i < n; i++) {
        const float z = depth[i] - bias < far + 1 ? depth[i] - bias : far + 1;
        const int after = z > (float)(int32_t)(range[i] & ((1 << FIRST) - 1));
        const int dark = z > (float)(int32_t)((range[i] >> DARK) + 1);
        depth[i] = z;
        open[i] = after & !dark;
        occlusion[i] |= after & dark;
    }
    int32_t count = 0;
    for (int32_t i = 0; i < n; i++) {
        rays->point[count] = i;
        count += open[i];
    }
    rays->count = count;
    for (int32_t k = 0; k < count; k++) {
        const int32_t i = rays->point[k];
        rays->tile[k] = tile[i];
        rays->depth[k] = depth[i];
        rays->u[k] = u[i];
        rays->v[k] = v[i];
        rays->slope_a[k] = slope_a[i];
        rays->slope_b[k] = slope_b[i];
    }
}

/* Place each ray's samples, and its end at the point. */
static void place(const Light *light, const Field *field, Rays *rays) {
    const int m = light->axes[0], a = light->axes[1], b = light->axes[2];
    const int32_t block = 1 << (CELL + light->merged), planes = per_slab(light, field) * light->deep;
    const int32_t step = (1 << CELL) / field->density, step_m = light->back ? -step : step;
    const float share = 1.0f / (float)field->density;
    const int32_t far_m = light->back ? light->deep * block : 0, start_m = far_m + (step_m >> 1);
    const int32_t low_a = (light->low[0] + light->middle[0]) * block;
    const int32_t low_b = (light->low[1] + light->middle[1]) * block;
    const float middle_a = (float)light->middle[0], middle_b = (float)light->middle[1];
    const float far = (float)light->deep, unit = (float)block, cell = (float)(1 << CELL);
    const float density = (float)per_slab(light, field);
    for (int32_t k = 0; k < rays->count; k++) {
        const float depth = rays->depth[k], left = far - depth;
        const float slope_a = rays->slope_a[k], slope_b = rays->slope_b[k];
        const int32_t far_a = fixed(rays->u[k] - middle_a, unit) + low_a;
        const int32_t far_b = fixed(rays->v[k] - middle_b, unit) + low_b;
        const int32_t step_a = fixed(slope_a * share, cell), step_b = fixed(slope_b * share, cell);
        const int32_t end_m = fixed(depth, unit);
        rays->planes[k] = least((int32_t)ceilf(depth * density - 0.5f), planes);
        rays->step[m][k] = step_m;
        rays->step[a][k] = step_a;
        rays->step[b][k] = step_b;
        rays->start[m][k] = start_m;
        rays->start[a][k] = far_a - planes * step_a + (step_a >> 1);
        rays->start[b][k] = far_b - planes * step_b + (step_b >> 1);
        rays->end[m][k] = light->back ? far_m - end_m : end_m;
        rays->end[a][k] = far_a - fixed(slope_a * left, unit);
        rays->end[b][k] = far_b - fixed(slope_b * left, unit);
    }
    for (int32_t k = 0; k < rays->count; k++) {
        int within = rays->depth[k] <= far;
        for (int axis = 0; axis < 3; axis++) {
            const int32_t brick = rays->end[axis][k] >> BRICK;
            within &= (brick > 0) & (brick < field->shape[axis] - 1);
        }
        rays->within[k] = within;
    }
}

/* List eight samples of a ray from sample k on; count those wanted. */
static inline void list_eight(Samples *samples, const Rays *rays, int32_t ray, int32_t k,
                              int32_t wanted) {
    const int32_t to = samples->count;
    for (int axis = 0; axis < 3; axis++)
        *(Eight *)(samples->at[axis] + to) =
            rays->start[axis][ray] + (k + NUMBERS) * rays->step[axis][ray];
    *(Eight *)(samples->point + to) = rays->point[ray] + 0 * NUMBERS;
    samples->count += wanted;
}

static inline void list_end(Samples *samples, const Rays *rays, int32_t ray) {
    const int32_t to = samples->count;
    for (int axis = 0; axis < 3; axis++) samples->at[axis][to] = rays->end[axis][ray];
    samples->point[to] = rays->point[ray];
    samples->count += rays->within[ray];
}

/* Between samples of a sheet that do not follow each other: the box's corner is void. */
static inline void list_gap(Samples *samples) {
    const int32_t to = samples->count++;
    for (int axis = 0; axis < 3; axis++) samples->at[axis][to] = 0;
    samples->point[to] = 0;
}

/* The first run of slabs of a ray's tile: its first sample and the end. */
typedef struct {
    int32_t start, end, more;
} Run;

static inline Run first_run(const Light *light, const Field *field, int32_t tile) {
    const uint32_t range = light->ranges[tile];
    const uint64_t slabs = light->slabs[tile];
    const int32_t start = per_slab(light, field) * (int32_t)(range & ((1 << FIRST) - 1));
    const int32_t length = ~slabs ? __builtin_ctzll(~slabs) : 64;
    const int32_t end = start + length * (per_slab(light, field) << (range >> DOUBLED & 7));
    return (Run){start, end, length < 64 && slabs >> length};
}

/* List the first samples of all rays, and their ends; return the number of rays with more samples,
   which are `later`. */
static int32_t list_first(const Light *light, const Field *field, int32_t lit, Work *work) {
    const Rays *rays = &work->rays;
    Samples *samples = &work->samples;
    int32_t rest = 0;
    for (int32_t ray = 0; ray < rays->count; ray++) {
        const Run run = first_run(light, field, rays->tile[ray]);
        const int32_t planes = rays->planes[ray], start = most(run.start - field->sheet, lit);
        const int32_t wanted = most(least(run.end + field->sheet, planes) - start, 0);
        list_eight(samples, rays, ray, start, least(wanted, EARLY));
        work->listed[ray] = least(wanted, EARLY);
        work->later[rest] = ray;
        rest += (wanted > EARLY) | (run.more & (planes > run.end));
        if (field->sheet) {
            list_gap(samples);
            list_eight(samples, rays, ray, planes - 1, rays->within[ray] & (planes > lit));
        }
        list_end(samples, rays, ray);
        if (field->sheet) list_gap(samples);
    }
    return rest;
}

/* List so many further samples of a ray, if it has them; return whether there are more. */
static int list_further(const Light *light, const Field *field, int32_t lit, int32_t ray,
                        int32_t further, Work *work) {
    const Rays *rays = &work->rays;
    Samples *samples = &work->samples;
    const int32_t tile = rays->tile[ray], planes = rays->planes[ray];
    const uint32_t range = light->ranges[tile];
    const int32_t first = per_slab(light, field) * (int32_t)(range & ((1 << FIRST) - 1));
    const int32_t of_bit = per_slab(light, field) << (range >> DOUBLED & 7);
    /* In all of its samples; a sheet's last one again, for its pair. */
    const int32_t from = work->listed[ray] - field->sheet, to = work->listed[ray] + further;
    uint64_t slabs = light->slabs[tile];
    int32_t before = 0;
    work->listed[ray] = to;
    while (slabs) {
        const int32_t slab = __builtin_ctzll(slabs);
        const int32_t length = ~(slabs >> slab) ? __builtin_ctzll(~(slabs >> slab)) : 64;
        slabs = slab + length > 63 ? 0 : slabs >> (slab + length) << (slab + length);
        const int32_t run = first + slab * of_bit, run_end = run + length * of_bit;
        if (run >= planes) return 0;
        if (before >= to) return 1;
        const int32_t start = most(run - field->sheet, lit);
        const int32_t count = most(least(run_end + field->sheet, planes) - start, 0);
        const int32_t end = least(to - before, count);
        int32_t k = most(from - before, 0);
        for (; k < end; k += 8) list_eight(samples, rays, ray, start + k, least(end - k, 8));
        if (field->sheet) list_gap(samples);
        if (end < count) return 1;
        before += count;
    }
    return 0;
}

/* Test between a word's corners: `positive_at` of cell_words.py. */
static inline int is_inside(uint64_t word, int wide, uint32_t at_x, uint32_t at_y, uint32_t at_z) {
    const uint64_t whole = 1 << PART, halves = 0x0000FFFF0000FFFF, low = 0xFFFFFFFF;
    const uint64_t x = at_x >> (CELL - PART) & (whole - 1), y = at_y >> (CELL - PART) & (whole - 1);
    uint64_t z = at_z >> (CELL - PART) & (whole - 1), ends;
    if (wide) {
        const uint64_t lanes = 0x00FF00FF00FF00FF;
        z >>= PART - 8;
        ends = (word & lanes) * (256 - z) + (word >> 8 & lanes) * z;
        ends = (ends & halves) * (whole - y) + (ends >> 16 & halves) * y;
        return (ends & low) * (whole - x) + (ends >> 32) * x > (uint64_t)255 << (2 * PART + 7);
    }
    const uint64_t lanes = 0x000F000F000F000F, both = word | word >> 4 << 32;
    ends = (both & lanes) * (whole - y) + (both >> 8 & lanes) * y;
    ends = (ends & halves) * (whole - x) + (ends >> 16 & halves) * x;
    return (ends & low) * (whole - z) + (ends >> 32) * z > (uint64_t)15 << (3 * PART - 1);
}

#ifdef __AVX2__
/* Bits of a coordinate's fraction of a cell, each in a 64-bit lane; in all four parts if spread. */
static inline __m256i fraction(__m128i at, int bits, int spread) {
    const __m128i part = _mm_and_si128(_mm_srli_epi32(at, CELL - bits), _mm_set1_epi32((1 << bits) - 1));
    const __m256i lanes = _mm256_cvtepi32_epi64(part);
    const int64_t low = 0x0100010001000100, high = low + 0x0808080808080808;
    return spread ? _mm256_shuffle_epi8(lanes, _mm256_set_epi64x(high, low, high, low)) : lanes;
}

/* `is_inside` of four words of 64 bits, as bits. Differences from 127.5 of bytes are interpolated
   along z, y and x: in lanes of 16, 32 and 64 bits. */
static inline int four_inside(__m256i words, __m128i at_x, __m128i at_y, __m128i at_z) {
    const __m256i x = fraction(at_x, PART, 0), y = fraction(at_y, PART, 1), z = fraction(at_z, 8, 1);
    const __m256i even = _mm256_and_si256(words, _mm256_set1_epi16(255));
    const __m256i odd = _mm256_srli_epi16(words, 8);
    const __m256i near_z = _mm256_mullo_epi16(even, _mm256_sub_epi16(_mm256_set1_epi16(256), z));
    const __m256i along_z = _mm256_sub_epi16(_mm256_add_epi16(near_z, _mm256_mullo_epi16(odd, z)),
                                             _mm256_set1_epi16(255 << 7));
    const __m256i signs = _mm256_set1_epi32(0x0001FFFF), whole = _mm256_set1_epi32(1 << PART);
    const __m256i shares = _mm256_add_epi16(_mm256_sign_epi16(y, signs), whole); /* 1 - y, y */
    const __m256i along_y = _mm256_madd_epi16(along_z, shares);
    const __m256i near_x = _mm256_mul_epi32(along_y, _mm256_sub_epi64(_mm256_set1_epi64x(1 << PART), x));
    const __m256i value = _mm256_add_epi64(near_x, _mm256_mul_epi32(_mm256_srli_epi64(along_y, 32), x));
    const __m256i inside = _mm256_cmpgt_epi64(value, _mm256_setzero_si256());
    return _mm256_movemask_pd(_mm256_castsi256_pd(inside));
}

/* States of eight samples in crossed cells, from number c on, as bits. */
static inline int eight_inside(const uint64_t *words, const Samples *samples, int32_t c) {
    const __m256i k = _mm256_loadu_si256((const __m256i *)(samples->crossed + c));
    const __m256i x = _mm256_i32gather_epi32(samples->at[0], k, 4);
    const __m256i y = _mm256_i32gather_epi32(samples->at[1], k, 4);
    const __m256i z = _mm256_i32gather_epi32(samples->at[2], k, 4);
    const __m128i *word = (const __m128i *)(samples->word + c);
    const long long *table = (const long long *)words;
    const __m256i first = _mm256_i32gather_epi64(table, _mm_loadu_si128(word), 8);
    const __m256i last = _mm256_i32gather_epi64(table, _mm_loadu_si128(word + 1), 8);
    return four_inside(first, _mm256_castsi256_si128(x), _mm256_castsi256_si128(y),
                       _mm256_castsi256_si128(z)) |
           four_inside(last, _mm256_extracti128_si256(x, 1), _mm256_extracti128_si256(y, 1),
                       _mm256_extracti128_si256(z, 1)) << 4;
}
#endif

/* Fill the states of samples in crossed cells, which are `OUTSIDE` till then. */
static void interpolate(const Field *field, Samples *samples, int32_t count) {
    int32_t c = 0;
#ifdef __AVX2__
    if (field->word_bytes == 8)
        for (; c + 8 <= count; c += 8) {
            int inside = eight_inside(field->words, samples, c);
            for (; inside; inside &= inside - 1)
                samples->state[samples->crossed[c + __builtin_ctz(inside)]] = INSIDE;
        }
#endif
    for (; c < count; c++) {
        const int32_t k = samples->crossed[c], number = samples->word[c];
        const int wide = field->word_bytes == 8;
        const uint64_t word = wide ? ((const uint64_t *)field->words)[number]
                                   : ((const uint32_t *)field->words)[number];
        const int32_t x = samples->at[0][k], y = samples->at[1][k], z = samples->at[2][k];
        samples->state[k] = is_inside(word, wide, x, y, z) ? INSIDE : OUTSIDE;
    }
}

/* Fill the states of all samples. */
static void look_up(const Field *field, Samples *samples) {
    const int32_t n = samples->count, columns = field->columns, layers = field->layers;
    const int32_t *restrict x = samples->at[0], *restrict y = samples->at[1];
    const int32_t *restrict z = samples->at[2];
    int32_t *restrict node = samples->node, *restrict inner = samples->inner;
    for (int32_t k = 0; k < n; k++) {
        assert(x[k] >= 0 && x[k] >> BRICK < field->shape[0]);
        assert(y[k] >= 0 && y[k] >> BRICK < field->shape[1]);
        assert(z[k] >= 0 && z[k] >> BRICK < field->shape[2]);
        const int32_t brick = (x[k] >> BRICK & 3) << 4 | (y[k] >> BRICK & 3) << 2 | (z[k] >> BRICK & 3);
        const int32_t cell = (x[k] >> CELL & 3) << 4 | (y[k] >> CELL & 3) << 2 | (z[k] >> CELL & 3);
        node[k] = ((x[k] >> NODE) * columns + (y[k] >> NODE)) * layers + (z[k] >> NODE);
        inner[k] = brick << 6 | cell;
    }
    int32_t count = 0;
    for (int32_t k = 0; k < n; k++) {
        const uint32_t brick = field->nodes[node[k]] + (inner[k] >> 6), cell = inner[k] & 63;
        const uint32_t row = field->row_bytes == 2 ? ((const uint16_t *)field->rows)[brick]
                                                   : ((const uint32_t *)field->rows)[brick];
        const uint64_t some = field->masks[2 * row], every = field->masks[2 * row + 1];
        const uint64_t before = some & ~every & (((uint64_t)1 << cell) - 1);
        /* Inside: both; void: every alone. */
        samples->state[k] = (every >> cell & 1) << (~some >> cell & 1);
        samples->crossed[count] = k;
        samples->word[count] = field->first[row] + __builtin_popcountll(before);
        count += (some & ~every) >> cell & 1;
    }
    interpolate(field, samples, count);
}

/* Mark the points with samples inside a solid, or with two in succession on both sides of a sheet;
   empty the list. */
static void mark(const Field *field, Samples *samples, uint8_t *occlusion) {
    look_up(field, samples);
    const int32_t n = samples->count;
    const uint8_t *state = samples->state;
    int32_t *marked = samples->node, count = 0;
    if (field->sheet)
        for (int32_t k = 1; k < n; k++) {
            marked[count] = samples->point[k];
            count += state[k - 1] + state[k] == OUTSIDE + INSIDE;
        }
    else
        for (int32_t k = 0; k < n; k++) {
            marked[count] = samples->point[k];
            count += state[k] == INSIDE;
        }
    for (int32_t k = 0; k < count; k++) occlusion[marked[k]] = 1;
    samples->count = 0;
}

/* Set `occlusion` of n points, whose rays are in the tables; returns 1 without memory. */
int32_t mark_occluded(const Field *field, const Light *light, const float *points, int64_t n,
                      float bias, uint8_t *occlusion) {
    const double behind = light->near ? ceil(per_slab(light, field) * light->source[0] - 0.5) : 0;
    const int32_t lit = behind > 0 ? (int32_t)behind : 0; /* planes before the light */
    Work *work = malloc(sizeof(Work));
    if (work == NULL) return 1;
    work->samples.count = 0;
    for (int64_t start = 0; start < n; start += BLOCK) {
        const int32_t count = n - start < BLOCK ? (int32_t)(n - start) : BLOCK;
        uint8_t *marked = occlusion + start;
        decide(light, field, points + 3 * start, count, bias, &work->rays, marked);
        place(light, field, &work->rays);
        int32_t rest = list_first(light, field, lit, work);
        mark(field, &work->samples, marked);
        for (int32_t further = FURTHER; rest > 0; further = MOST) {
            int32_t after = 0;
            for (int32_t k = 0; k < rest; k++) {
                const int32_t ray = work->later[k];
                if (marked[work->rays.point[ray]]) continue;
                work->later[after] = ray;
                after += list_further(light, field, lit, ray, further, work);
                if (work->samples.count > SAMPLES) mark(field, &work->samples, marked);
            }
            mark(field, &work->samples, marked);
            rest = after;
        }
    }
    free(work);
    return 0;
}
