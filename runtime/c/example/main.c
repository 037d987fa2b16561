/* A top by two methods, and a probe, in C. Prints the bits of their numbers, one number a line, and ends with another status than 0 where something is wrong. */

#include "fine_top.h"
#include "heavy_top.h"
#include "probe.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define CHECK(condition)                                           \
    do {                                                           \
        if (!(condition)) {                                        \
            fprintf(stderr, "main.c:%d: %s\n", __LINE__, #condition); \
            return 1;                                              \
        }                                                          \
    } while (0)

static void print_doubles(const void *numbers, size_t bytes) {
    for (size_t i = 0; i < bytes; i += 8) {
        uint64_t bits;
        memcpy(&bits, (const char *)numbers + i, 8);
        printf("%016" PRIx64 "\n", bits);
    }
}

static void print_floats(const void *numbers, size_t bytes) {
    for (size_t i = 0; i < bytes; i += 4) {
        uint32_t bits;
        memcpy(&bits, (const char *)numbers + i, 4);
        printf("%08" PRIx32 "\n", bits);
    }
}

static int top(void) {
    const heavy_top_parameters parameters = {
        .mass_matrix = {{0.5, 0.125, 0}, {0.125, 0.75, 0}, {0, 0, 0.25}},
        .weight = 2,
        .center = {0, 0.25, 1},
    };
    const heavy_top_numbers start = {.R = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .N = {0.5, 0.25, 2}};
    heavy_top_stepper stepper;
    heavy_top_state state;
    CHECK(heavy_top_make(&stepper, sizeof stepper, &parameters, 0.015625) == CLEBSCH_OK);
    CHECK(heavy_top_start(&stepper, &state, sizeof state, &start) == CLEBSCH_OK);
    for (int i = 0; i < 100; i++) CHECK(heavy_top_step(&stepper, &state) == CLEBSCH_OK);
    CHECK(heavy_top_advance(&stepper, &state, 900) == CLEBSCH_OK);
    const heavy_top_impulse impulse = {.N = {0.125, 0, -0.5}};
    CHECK(heavy_top_kick(&stepper, &state, &impulse) == CLEBSCH_OK);
    CHECK(heavy_top_step(&stepper, &state) == CLEBSCH_OK);
    heavy_top_numbers end;
    double energy;
    CHECK(heavy_top_read(&state, &end) == CLEBSCH_OK);
    CHECK(heavy_top_energy(&stepper, &state, &energy) == CLEBSCH_OK);
    print_doubles(&end, sizeof end);
    print_doubles(&energy, sizeof energy);

    /* each mistake has its status, and changes nothing */
    const heavy_top_state before = state;
    heavy_top_parameters broken = parameters;
    broken.weight = NAN;
    heavy_top_numbers mirrored = start;
    mirrored.R[2][2] = -1;
    heavy_top_stepper other = stepper;
    CHECK(heavy_top_make(&other, sizeof other, &broken, 0.1) == CLEBSCH_NOT_FINITE);
    CHECK(heavy_top_make(&other, sizeof other, &parameters, 0) == CLEBSCH_STEP_SIZE);
    CHECK(heavy_top_make(&other, sizeof other - 8, &parameters, 0.1) == CLEBSCH_SIZE);
    CHECK(heavy_top_make(&other, sizeof other, NULL, 0.1) == CLEBSCH_NULL);
    CHECK(heavy_top_make(NULL, sizeof other, &parameters, 0.1) == CLEBSCH_NULL);
    CHECK(heavy_top_start(&stepper, &state, sizeof state, &mirrored) == CLEBSCH_OFF_ORBIT);
    CHECK(heavy_top_start(&stepper, &state, sizeof state + 8, &start) == CLEBSCH_SIZE);
    CHECK(heavy_top_step(&stepper, NULL) == CLEBSCH_NULL);
    CHECK(heavy_top_step(NULL, &state) == CLEBSCH_NULL);
    CHECK(heavy_top_kick(&stepper, &state, NULL) == CLEBSCH_NULL);
    const heavy_top_impulse overflow = {.N = {0, INFINITY, 0}};
    CHECK(heavy_top_kick(&stepper, &state, &overflow) == CLEBSCH_NOT_FINITE);
    CHECK(memcmp(&state, &before, sizeof state) == 0 && memcmp(&other, &stepper, sizeof other) == 0);

    /* a step that is too long, in words */
    heavy_top_numbers fast = start;
    fast.N[2] = 200;
    CHECK(heavy_top_start(&stepper, &state, sizeof state, &fast) == CLEBSCH_OK);
    CHECK(heavy_top_step(&stepper, &state) == CLEBSCH_UNSOLVABLE);
    clebsch_message message;
    CHECK(heavy_top_explain(&parameters, 0.015625, &fast, NULL, &message) == CLEBSCH_UNSOLVABLE);
    CHECK(strstr(message.text, "reduce the step size") != NULL);
    CHECK(heavy_top_explain(&broken, 0.015625, NULL, NULL, &message) == CLEBSCH_NOT_FINITE);
    CHECK(strncmp(message.text, "weight is not finite", 20) == 0);
    CHECK(heavy_top_explain(&parameters, 0.015625, &start, NULL, &message) == CLEBSCH_OK && message.text[0] == 0);
    return 0;
}

static int fine(void) {
    const fine_top_parameters parameters = {
        .mass_matrix = {{0.5, 0.125, 0}, {0.125, 0.75, 0}, {0, 0, 0.25}},
        .weight = 2,
        .center = {0, 0.25, 1},
    };
    const fine_top_numbers start = {.R = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .N = {0.5, 0.25, 2}};
    fine_top_stepper stepper;
    fine_top_state state;
    fine_top_numbers end;
    CHECK(fine_top_make(&stepper, sizeof stepper, &parameters, 0.0625) == CLEBSCH_OK);
    CHECK(fine_top_start(&stepper, &state, sizeof state, &start) == CLEBSCH_OK);
    CHECK(fine_top_advance(&stepper, &state, 50) == CLEBSCH_OK);
    CHECK(fine_top_read(&state, &end) == CLEBSCH_OK);
    print_doubles(&end, sizeof end);
    return 0;
}

static int fly(void) {
    const probe_parameters parameters = {.mass = 2, .moments = {1, 1.5f, 2}, .stiffness = 8, .drift = {0.25f, 0, 0}};
    const probe_numbers start = {.t = 0.5f, .x = {0.5f, 0, 0.25f}, .Q = {0, 0, 1, 0}, .N = {0, 1, 0, 0.5f, 0.25f, 0.125f}};
    const probe_input input = {.u = {._0 = {0.25f, 0, 0}, ._1 = {0, 0, 0.125f}}};
    probe_stepper stepper;
    probe_state state;
    probe_numbers end;
    CHECK(probe_make(&stepper, sizeof stepper, &parameters, 0.0625f) == CLEBSCH_OK);
    CHECK(probe_start(&stepper, &state, sizeof state, &start) == CLEBSCH_OK);
    CHECK(probe_read(&state, &end) == CLEBSCH_OK && memcmp(&start, &end, sizeof end) == 0);
    for (int i = 0; i < 200; i++) CHECK(probe_step_with(&stepper, &state, &input) == CLEBSCH_OK);
    CHECK(probe_step_with(&stepper, &state, NULL) == CLEBSCH_NULL);
    CHECK(probe_read(&state, &end) == CLEBSCH_OK);
    print_floats(&end, sizeof end);
    return 0;
}

int main(void) { return top() || fine() || fly(); }
