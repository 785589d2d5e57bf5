/* Visibility of the public functions: everything else of the library stays hidden. */
#ifndef RICOCHET_EXPORT_H
#define RICOCHET_EXPORT_H

#if defined(__GNUC__) || defined(__clang__)
#define RIC_API __attribute__((visibility("default")))
#else
#define RIC_API
#endif

#endif
