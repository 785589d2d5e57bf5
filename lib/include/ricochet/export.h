/* Visibility of the public functions: everything else of the library stays hidden. And their linkage in C++: the
 * declarations of every public header stand between RIC_BEGIN_DECLARATIONS and RIC_END_DECLARATIONS. */
#ifndef RICOCHET_EXPORT_H
#define RICOCHET_EXPORT_H

#if defined(__GNUC__) || defined(__clang__)
#define RIC_API __attribute__((visibility("default")))
#else
#define RIC_API
#endif

#ifdef __cplusplus
#define RIC_BEGIN_DECLARATIONS extern "C" {
#define RIC_END_DECLARATIONS   }
#else
#define RIC_BEGIN_DECLARATIONS
#define RIC_END_DECLARATIONS
#endif

#endif
