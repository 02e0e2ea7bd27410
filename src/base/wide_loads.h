// Loads and stores of vectors, for loops that process several numbers at a time. Included inside
// the namespace of such loops, which defines the vector type (Wide) and the instruction set
// (PALPATE_TARGET); without `#pragma once`, because it is included once per instruction set.
#if !defined(PALPATE_TARGET)
#error "loops for a kind of processor include this"
#endif
#define PALPATE_INLINE PALPATE_TARGET __attribute__((always_inline)) inline

PALPATE_INLINE Wide load(const double* from) {
  Wide values;
  __builtin_memcpy(&values, from, sizeof values);
  return values;
}

PALPATE_INLINE void store(double* to, const Wide& values) {
  __builtin_memcpy(to, &values, sizeof values);
}
