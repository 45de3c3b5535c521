/* Which points of a binary file see the sun:  ./sample statue.field points.bin 1 2 0.5 answers.bin
 *
 * points.bin has three floats a point, answers.bin gets a byte for each: 1 in shadow.
 *     cc -O3 -march=native sample.c -o sample -lm
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define SHADOW_FIELD_IMPLEMENTATION
#include "shadow_field.h"

int main(int count, char **arguments)
{
    shadow_field field;
    float point[3], to_sun[3];
    size_t points = 0, dark = 0;
    if (count != 7) {
        fprintf(stderr, "usage: sample FIELD POINTS X Y Z ANSWERS\n");
        return 2;
    }
    const char *problem = shadow_field_load(&field, arguments[1]);
    if (problem) {
        fprintf(stderr, "%s: %s\n", arguments[1], problem);
        return 1;
    }
    for (int axis = 0; axis < 3; axis++) to_sun[axis] = strtof(arguments[3 + axis], NULL);
    FILE *in = fopen(arguments[2], "rb"), *out = fopen(arguments[6], "wb");
    if (!in || !out) {
        fprintf(stderr, "%s: cannot be opened\n", in ? arguments[6] : arguments[2]);
        return 1;
    }
    clock_t started = clock();
    while (fread(point, sizeof point, 1, in) == 1) {
        int occluded = shadow_field_occluded(&field, point, to_sun);
        fputc(occluded, out);
        dark += (size_t)occluded;
        points++;
    }
    double seconds = (double)(clock() - started) / CLOCKS_PER_SEC;
    printf("%zu of %zu points in shadow, %.2f million a second\n", dark, points, 1e-6 * (double)points / seconds);
    fclose(in);
    fclose(out);
    shadow_field_free(&field);
    return 0;
}
