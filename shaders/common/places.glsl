// SPDX-License-Identifier: MIT
// The place of a particle in an output slot: how many of those that live were given or born before it. places.comp counts
// them; where nobody comes or goes it is the identity.
#ifndef SLUICE_PLACES_GLSL
#define SLUICE_PLACES_GLSL

// A bit for each identity that lives.
bool lives(uint marks, uint identity) { return (marks & (1u << (identity & 31u))) != 0u; }

// `before`: how many live below the first identity of the word that has the bit.
uint placeOf(uint marks, uint before, uint identity) {
    return before + uint(bitCount(marks & ((1u << (identity & 31u)) - 1u)));
}

#endif
