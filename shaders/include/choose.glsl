// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// One of as many as there are colliders, four at most. Where an index is no constant, llvmpipe
// reads an array lane by lane; to choose among constant places takes it an instruction for each.

#if COLLIDERS == 1
#define CHOOSE(I, A, B, C, D) (A)
#define FIRST_OF(A, B, C, D) A
#define PUT(ARRAY, I, VALUE) ARRAY[0] = VALUE
#elif COLLIDERS == 2
#define CHOOSE(I, A, B, C, D) ((I) == 0 ? A : B)
#define FIRST_OF(A, B, C, D) A, B
#define PUT(ARRAY, I, VALUE) PUT_AT(ARRAY, 0, I, VALUE), PUT_AT(ARRAY, 1, I, VALUE)
#elif COLLIDERS == 3
#define CHOOSE(I, A, B, C, D) ((I) == 0 ? A : (I) == 1 ? B : C)
#define FIRST_OF(A, B, C, D) A, B, C
#define PUT(ARRAY, I, VALUE) \
    PUT_AT(ARRAY, 0, I, VALUE), PUT_AT(ARRAY, 1, I, VALUE), PUT_AT(ARRAY, 2, I, VALUE)
#else
#define CHOOSE(I, A, B, C, D) ((I) == 0 ? A : (I) == 1 ? B : (I) == 2 ? C : D)
#define FIRST_OF(A, B, C, D) A, B, C, D
#define PUT(ARRAY, I, VALUE) \
    PUT_AT(ARRAY, 0, I, VALUE), PUT_AT(ARRAY, 1, I, VALUE), PUT_AT(ARRAY, 2, I, VALUE), \
    PUT_AT(ARRAY, 3, I, VALUE)
#endif
#define PUT_AT(ARRAY, PLACE, I, VALUE) ARRAY[PLACE] = (I) == PLACE ? VALUE : ARRAY[PLACE]

// The element I of an array of four at most; PUT changes it.
#define AT(ARRAY, I) CHOOSE(I, ARRAY[0], ARRAY[1], ARRAY[2], ARRAY[3])
