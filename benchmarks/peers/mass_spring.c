// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Steps of a cloth of springs on one core: structure of arrays, vectorised by the compiler.
//
// Every plane has a border of zeros: 2 rows above and below, BORDER columns on each side. Rows of
// buffers have the border too, so that no neighbour needs a branch.

#include <math.h>

#define BORDER 16
// Columns that are done in one go: what they keep of a row stays in the first-level cache.
#define STRIP 512
#define LEAST_SQUARE 1e-20f
// Along a row, along a column, both diagonals, two along each.
enum { ROW, COLUMN, DIAGONAL, CROSSING, TWO_ROW, TWO_COLUMN, KINDS };

// All times dt / m: the pull over the length l is k - (kl - kd dl/dt) / l.
struct law {
    float k[KINDS], kl[KINDS], kd[KINDS];
};

struct cloth {
    int rows, cols, pitch;
    float dt;
    float fall[3];       // dt g [m/s]
    struct law law;
    const float *free;   // 1, or 0 where pinned
    const float *node;   // 1, or 0 in the border
};

// What one row of springs does to the nodes that they start from.
struct forces {
    float *restrict x, *restrict y, *restrict z;
};

static inline float pull(
        float dx, float dy, float dz, float du, float dv, float dw, float k, float kl, float kd) {
    float inverse = 1.0f / sqrtf(fmaxf(dx * dx + dy * dy + dz * dz, LEAST_SQUARE));
    return k - inverse * (kl - kd * inverse * (dx * du + dy * dv + dz * dw));
}

// Of the spring from node c to node c + OFFSET.
#define PULL(OFFSET, KIND) \
    float dx = x[c + (OFFSET)] - x[c], dy = y[c + (OFFSET)] - y[c], dz = z[c + (OFFSET)] - z[c]; \
    float p = pull( \
        dx, dy, dz, u[c + (OFFSET)] - u[c], v[c + (OFFSET)] - v[c], w[c + (OFFSET)] - w[c], \
        law.k[KIND], law.kl[KIND], law.kd[KIND]);

static struct forces row_of(float *buffers, int number, int pitch) {
    float *first = buffers + 3L * number * pitch + BORDER;
    return (struct forces){first, first + pitch, first + 2 * pitch};
}

static void clear(struct forces forces, int at) {
    forces.x[at] = forces.y[at] = forces.z[at] = 0.0f;
}

// Rows of forces that the steps keep: of this row, and of one or two above where springs go down.
#define BUFFERS 11

// Each spring evaluated once, the state updated in place: row by row, since no spring that starts
// below ends in a row above. planes: x, y, z and their velocities. buffers: 3 BUFFERS rows.
void step_once(const struct cloth *cloth, float *const *planes, float *buffers, int count) {
    const int rows = cloth->rows, cols = cloth->cols;
    const long pitch = cloth->pitch;
    const float dt = cloth->dt;
    const float fall_x = cloth->fall[0], fall_y = cloth->fall[1], fall_z = cloth->fall[2];
    for (int step = 0; step < count; ++step) {
        for (long i = 0; i < 3L * BUFFERS * pitch; ++i) {
            buffers[i] = 0.0f;
        }
        for (int r = 0; r < rows; ++r) {
            struct law law = cloth->law;
            // No spring goes beyond the last row.
            for (int kind = 0; kind < KINDS; ++kind) {
                int down = kind == TWO_COLUMN ? 2 : kind != ROW && kind != TWO_ROW;
                if (r + down >= rows) {
                    law.k[kind] = law.kl[kind] = law.kd[kind] = 0.0f;
                }
            }
            const long at = (r + 2) * pitch + BORDER;
            float *restrict x = planes[0] + at, *restrict y = planes[1] + at;
            float *restrict z = planes[2] + at, *restrict u = planes[3] + at;
            float *restrict v = planes[4] + at, *restrict w = planes[5] + at;
            const float *restrict free = cloth->free + at;
            const int even = r % 2, odd = 1 - even;
            const struct forces row = row_of(buffers, 0, pitch);
            const struct forces two_row = row_of(buffers, 1, pitch);
            const struct forces column = row_of(buffers, 2 + even, pitch);
            const struct forces column_above = row_of(buffers, 2 + odd, pitch);
            const struct forces diagonal = row_of(buffers, 4 + even, pitch);
            const struct forces diagonal_above = row_of(buffers, 4 + odd, pitch);
            const struct forces crossing = row_of(buffers, 6 + even, pitch);
            const struct forces crossing_above = row_of(buffers, 6 + odd, pitch);
            const struct forces two_column = row_of(buffers, 8 + r % 3, pitch);
            const struct forces two_column_above = row_of(buffers, 8 + (r + 1) % 3, pitch);
            for (int first = 0; first < cols; first += STRIP) {
                const int end = first + STRIP < cols ? first + STRIP : cols;
#define KEEP(FORCES, OFFSET, KIND) { \
    PULL(OFFSET, KIND) \
    FORCES.x[c] = p * dx; \
    FORCES.y[c] = p * dy; \
    FORCES.z[c] = p * dz; \
}
#pragma GCC ivdep
                for (int c = first; c < end; ++c) {
                    KEEP(row, 1, ROW)
                    KEEP(two_row, 2, TWO_ROW)
                    KEEP(column, pitch, COLUMN)
                    KEEP(two_column, 2 * pitch, TWO_COLUMN)
                    KEEP(diagonal, pitch + 1, DIAGONAL)
                    KEEP(crossing, pitch - 1, CROSSING)
                }
                // Nor beyond the first and the last column.
                if (first == 0) {
                    clear(crossing, 0);
                }
                if (end == cols) {
                    clear(row, cols - 1);
                    clear(diagonal, cols - 1);
                    clear(two_row, cols - 1);
                    clear(two_row, cols - 2);
                }
#define TOTAL(AXIS) \
    (row.AXIS[c] - row.AXIS[c - 1] + two_row.AXIS[c] - two_row.AXIS[c - 2] \
     + column.AXIS[c] - column_above.AXIS[c] + two_column.AXIS[c] - two_column_above.AXIS[c] \
     + diagonal.AXIS[c] - diagonal_above.AXIS[c - 1] \
     + crossing.AXIS[c] - crossing_above.AXIS[c + 1])
#pragma GCC ivdep
                for (int c = first; c < end; ++c) {
                    u[c] += free[c] * (fall_x + TOTAL(x));
                    v[c] += free[c] * (fall_y + TOTAL(y));
                    w[c] += free[c] * (fall_z + TOTAL(z));
                    x[c] += dt * u[c];
                    y[c] += dt * v[c];
                    z[c] += dt * w[c];
                }
            }
        }
    }
}

// Each node gathers from its 12 neighbours. planes: those of the state before, then those after.
static void gather(const struct cloth *cloth, float *const *before, float *const *after) {
    const long pitch = cloth->pitch;
    const struct law law = cloth->law;
    const float dt = cloth->dt;
    const float fall_x = cloth->fall[0], fall_y = cloth->fall[1], fall_z = cloth->fall[2];
    for (int r = 0; r < cloth->rows; ++r) {
        const long at = (r + 2) * pitch + BORDER;
        const float *restrict x = before[0] + at, *restrict y = before[1] + at;
        const float *restrict z = before[2] + at, *restrict u = before[3] + at;
        const float *restrict v = before[4] + at, *restrict w = before[5] + at;
        const float *restrict node = cloth->node + at, *restrict free = cloth->free + at;
        float *restrict x_out = after[0] + at, *restrict y_out = after[1] + at;
        float *restrict z_out = after[2] + at, *restrict u_out = after[3] + at;
        float *restrict v_out = after[4] + at, *restrict w_out = after[5] + at;
#define ADD(OFFSET, KIND) { \
    PULL(OFFSET, KIND) \
    p *= node[c + (OFFSET)]; \
    fx += p * dx; \
    fy += p * dy; \
    fz += p * dz; \
}
#define ADD_BOTH(OFFSET, KIND) ADD(OFFSET, KIND) ADD(-(OFFSET), KIND)
#pragma GCC ivdep
        for (int c = 0; c < cloth->cols; ++c) {
            float fx = fall_x, fy = fall_y, fz = fall_z;
            ADD_BOTH(1, ROW)
            ADD_BOTH(2, TWO_ROW)
            ADD_BOTH(pitch, COLUMN)
            ADD_BOTH(2 * pitch, TWO_COLUMN)
            ADD_BOTH(pitch + 1, DIAGONAL)
            ADD_BOTH(pitch - 1, CROSSING)
            u_out[c] = u[c] + free[c] * fx;
            v_out[c] = v[c] + free[c] * fy;
            w_out[c] = w[c] + free[c] * fz;
            x_out[c] = x[c] + dt * u_out[c];
            y_out[c] = y[c] + dt * v_out[c];
            z_out[c] = z[c] + dt * w_out[c];
        }
    }
}

// After an even count the state is in the first planes again; after an odd one in the others.
void step_gather(const struct cloth *cloth, float *const *planes, float *const *others, int count) {
    for (int step = 0; step < count; ++step) {
        gather(cloth, step % 2 ? others : planes, step % 2 ? planes : others);
    }
}
