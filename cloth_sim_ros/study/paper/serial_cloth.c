// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The serial CPU version that the paper compares with: one thread, plain loops over springs,
// constraints and nodes, float32 as in the shaders. No SIMD, no blocking, no reordering: it is the
// naive program of the paper, not a fast one. study/paper/serial.py compiles and calls it.

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    int nodes;
    int edges;
    const int *first;            // node of each edge
    const int *second;
    const float *rest;           // [m]
    const float *stiffness;      // [N/m]
    const float *damping;        // [N s/m]
    const float *inverse_mass;   // of each node [1/kg], 0 where it is pinned
    const float *diagonal;       // of each edge as a constraint, what regularises the matrix [1/kg]
    const unsigned char *limited;  // whether an edge can be a constraint; NULL: none can
    float *force;                // three floats a node, to work on
    int *constraints;            // an int an edge, to work on; NULL where ``limited`` is
    float gravity[3];            // [m/s2]
    float step;                  // h [s]
    float threshold;             // strain beyond which it is one; below 0: always
    float tolerance;             // of conjugate gradients: residual over that at the start
    int most_iterations;
    int forms_matrix;            // J W J^T pair by pair (paper, Tab. 6), else never formed
} Cloth;

typedef struct {
    int count;
    const int *edge;  // of each constraint
    int *columns;     // JA, six for each
    float *values;    // A, six for each
    float *right;
    float *lambda;
} Constraints;

typedef struct {
    size_t count;
    size_t room;
    int *row;
    int *column;
    float *value;
} Triplets;

static float length_of(const Cloth *cloth, const float *x, int edge, float *d) {
    for (int axis = 0; axis < 3; ++axis) {
        d[axis] = x[3 * cloth->first[edge] + axis] - x[3 * cloth->second[edge] + axis];
    }
    return sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

static int is_constraint(const Cloth *cloth, int edge, float length) {
    return cloth->limited && cloth->limited[edge]
        && fabsf(length - cloth->rest[edge]) > cloth->threshold * cloth->rest[edge];
}

// Paper, eq. 1 and Tab. 1: a loop over springs gives each force to both ends. Returns how many
// edges are constraints, which are left out.
static int add_spring_forces(const Cloth *cloth, const float *x, const float *v) {
    float *force = cloth->force;
    int count = 0;
    for (int edge = 0; edge < cloth->edges; ++edge) {
        float d[3];
        float length = length_of(cloth, x, edge, d);
        if (is_constraint(cloth, edge, length)) {
            cloth->constraints[count++] = edge;
            continue;
        }
        int first = 3 * cloth->first[edge];
        int second = 3 * cloth->second[edge];
        float per_length = length > 0.0f ? 1.0f / length : 0.0f;
        float rate = 0.0f;
        for (int axis = 0; axis < 3; ++axis) {
            rate += (v[first + axis] - v[second + axis]) * d[axis];
        }
        float tension = cloth->stiffness[edge] * (length - cloth->rest[edge])
            + cloth->damping[edge] * rate * per_length;
        for (int axis = 0; axis < 3; ++axis) {
            float pull = tension * per_length * d[axis];
            force[first + axis] -= pull;
            force[second + axis] += pull;
        }
    }
    return count;
}

// Paper, Tab. 2, which also clears the forces.
static void add_velocities(const Cloth *cloth, float *v) {
    for (int node = 0; node < cloth->nodes; ++node) {
        float inverse_mass = cloth->inverse_mass[node];
        for (int axis = 0; axis < 3; ++axis) {
            float gravity = inverse_mass > 0.0f ? cloth->gravity[axis] : 0.0f;
            v[3 * node + axis] += cloth->step
                * (gravity + inverse_mass * cloth->force[3 * node + axis]);
            cloth->force[3 * node + axis] = 0.0f;
        }
    }
}

// disConstraint(), Vect() and Rhs() of the paper, with rows of unit length. An edge that is always
// a constraint has the compliance of the scene, so Phi is l - L0; beyond a threshold it is that of
// the paper, (l^2 - L0^2) / 2 l.
static void make_rows(const Cloth *cloth, const float *x, const float *v, Constraints *system) {
    float h = cloth->step;
    for (int i = 0; i < system->count; ++i) {
        int edge = system->edge[i];
        float d[3];
        float length = length_of(cloth, x, edge, d);
        float rest = cloth->rest[edge];
        float off = cloth->threshold < 0.0f
            ? length - rest : (length * length - rest * rest) / (2.0f * length);
        float rate = 0.0f;
        for (int axis = 0; axis < 3; ++axis) {
            int first = 3 * cloth->first[edge] + axis;
            int second = 3 * cloth->second[edge] + axis;
            float along = d[axis] / length;
            system->columns[6 * i + axis] = first;
            system->columns[6 * i + 3 + axis] = second;
            system->values[6 * i + axis] = along;
            system->values[6 * i + 3 + axis] = -along;
            rate += along * (v[first] - v[second]);
        }
        system->right[i] = off / (h * h) + rate / h;
    }
}

static int append(Triplets *matrix, int row, int column, float value) {
    if (matrix->count == matrix->room) {
        size_t room = 2 * matrix->room + 1024;
        int *rows = realloc(matrix->row, room * sizeof(int));
        if (rows) { matrix->row = rows; }
        int *columns = realloc(matrix->column, room * sizeof(int));
        if (columns) { matrix->column = columns; }
        float *values = realloc(matrix->value, room * sizeof(float));
        if (values) { matrix->value = values; }
        if (!rows || !columns || !values) {
            return 0;
        }
        matrix->room = room;
    }
    matrix->row[matrix->count] = row;
    matrix->column[matrix->count] = column;
    matrix->value[matrix->count++] = value;
    return 1;
}

// Spmm() of the paper, Tab. 6: each pair of constraints is looked at.
static int form_matrix(const Cloth *cloth, const Constraints *system, Triplets *matrix) {
    for (int i = 0; i < system->count; ++i) {
        for (int j = 0; j < system->count; ++j) {
            float value = 0.0f;
            for (int a = 6 * i; a < 6 * i + 6; ++a) {
                int column = system->columns[a];
                for (int b = 6 * j; b < 6 * j + 6; ++b) {
                    if (system->columns[b] == column) {
                        value += system->values[a] * cloth->inverse_mass[column / 3]
                            * system->values[b];
                    }
                }
            }
            if (i == j) {
                value += cloth->diagonal[system->edge[i]];
            }
            if (value != 0.0f && !append(matrix, i, j, value)) {
                return 0;
            }
        }
    }
    return 1;
}

static void multiply_triplets(const Triplets *matrix, int size, const float *p, float *image) {
    memset(image, 0, size * sizeof(float));
    for (size_t k = 0; k < matrix->count; ++k) {
        image[matrix->row[k]] += matrix->value[k] * p[matrix->column[k]];
    }
}

// The same product from J alone: out to the nodes and back.
static void multiply_rows(
        const Cloth *cloth, const Constraints *system, const float *p, float *image,
        float *at_nodes) {
    memset(at_nodes, 0, 3 * (size_t)cloth->nodes * sizeof(float));
    for (int i = 0; i < system->count; ++i) {
        for (int a = 6 * i; a < 6 * i + 6; ++a) {
            int column = system->columns[a];
            at_nodes[column] += system->values[a] * cloth->inverse_mass[column / 3] * p[i];
        }
    }
    for (int i = 0; i < system->count; ++i) {
        float sum = cloth->diagonal[system->edge[i]] * p[i];
        for (int a = 6 * i; a < 6 * i + 6; ++a) {
            sum += system->values[a] * at_nodes[system->columns[a]];
        }
        image[i] = sum;
    }
}

static double dot(const float *a, const float *b, int size) {
    double sum = 0.0;
    for (int i = 0; i < size; ++i) {
        sum += (double)a[i] * b[i];
    }
    return sum;
}

// Plain conjugate gradients from zero; returns the iterations, or -1 without memory.
static int solve(const Cloth *cloth, Constraints *system, float *at_nodes) {
    int size = system->count;
    Triplets matrix = {0, 0, NULL, NULL, NULL};
    float *vectors = malloc(3 * (size_t)size * sizeof(float));
    int iterations = -1;
    if (vectors && (!cloth->forms_matrix || form_matrix(cloth, system, &matrix))) {
        float *residual = vectors, *direction = vectors + size, *image = vectors + 2 * size;
        memcpy(residual, system->right, size * sizeof(float));
        memcpy(direction, system->right, size * sizeof(float));
        memset(system->lambda, 0, size * sizeof(float));
        double square = dot(residual, residual, size);
        double enough = square * cloth->tolerance * cloth->tolerance;
        for (iterations = 0; iterations < cloth->most_iterations && square > enough;
             ++iterations) {
            if (cloth->forms_matrix) {
                multiply_triplets(&matrix, size, direction, image);
            } else {
                multiply_rows(cloth, system, direction, image, at_nodes);
            }
            float length = (float)(square / dot(direction, image, size));
            for (int i = 0; i < size; ++i) {
                system->lambda[i] += length * direction[i];
                residual[i] -= length * image[i];
            }
            double next = dot(residual, residual, size);
            float keep = (float)(next / square);
            square = next;
            for (int i = 0; i < size; ++i) {
                direction[i] = residual[i] + keep * direction[i];
            }
        }
    }
    free(matrix.row);
    free(matrix.column);
    free(matrix.value);
    free(vectors);
    return iterations;
}

// Paper, Tab. 7: J^T lambda to the nodes.
static void add_constraint_forces(
        const Cloth *cloth, const Constraints *system, float *v) {
    for (int i = 0; i < system->count; ++i) {
        for (int a = 6 * i; a < 6 * i + 6; ++a) {
            int column = system->columns[a];
            v[column] -= cloth->step * cloth->inverse_mass[column / 3]
                * system->values[a] * system->lambda[i];
        }
    }
}

static int constrain(const Cloth *cloth, const float *x, float *v, Constraints *system) {
    size_t count = system->count;
    system->columns = malloc(6 * count * sizeof(int));
    system->values = malloc(6 * count * sizeof(float));
    system->right = malloc(count * sizeof(float));
    system->lambda = malloc(count * sizeof(float));
    float *at_nodes = malloc(3 * (size_t)cloth->nodes * sizeof(float));
    int iterations = -1;
    if (system->columns && system->values && system->right && system->lambda && at_nodes) {
        make_rows(cloth, x, v, system);
        iterations = solve(cloth, system, at_nodes);
        if (iterations >= 0) {
            add_constraint_forces(cloth, system, v);
        }
    }
    free(system->columns);
    free(system->values);
    free(system->right);
    free(system->lambda);
    free(at_nodes);
    return iterations;
}

// One step of h: positions [m] and velocities [m/s] are three floats a node, forces are zero before
// and after. Returns the iterations of conjugate gradients, or -1 without memory; ``held`` gets
// the number of constraints.
int serial_step(const Cloth *cloth, float *x, float *v, int *held) {
    Constraints system = {0, cloth->constraints, NULL, NULL, NULL, NULL};
    system.count = add_spring_forces(cloth, x, v);
    add_velocities(cloth, v);
    *held = system.count;
    int iterations = system.count ? constrain(cloth, x, v, &system) : 0;
    for (int i = 0; i < 3 * cloth->nodes; ++i) {
        x[i] += cloth->step * v[i];
    }
    return iterations;
}
