// How loops over several numbers at a time read and write them. Included inside the namespace of
// such loops, which names the vector (Wide) and what the compiler may use there (PALPATE_TARGET);
// no `#pragma once`: it comes once for each kind of processor.
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
