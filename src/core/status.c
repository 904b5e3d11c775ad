/* Version and texts of status codes. */
#include "tribo/tribo.h"

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)

int tribo_version(void)
{
    return TRIBO_VERSION;
}

const char *tribo_version_string(void)
{
    return TEXT(TRIBO_VERSION_MAJOR) "." TEXT(TRIBO_VERSION_MINOR) "." TEXT(TRIBO_VERSION_PATCH);
}

const char *tribo_strerror(int status)
{
    switch (status) {
    case TRIBO_OK:
        return "success";
    case TRIBO_ERR_NULL:
        return "a required argument is NULL";
    case TRIBO_ERR_NOT_FINITE:
        return "a value is NaN or infinite";
    case TRIBO_ERR_NEGATIVE:
        return "a value is negative";
    case TRIBO_ERR_NOT_POSITIVE:
        return "a value is not positive";
    case TRIBO_ERR_RANGE:
        return "an index or a choice is out of range";
    case TRIBO_ERR_SIZE:
        return "sizes do not fit each other, or are too large";
    case TRIBO_ERR_NAME:
        return "unknown name";
    case TRIBO_ERR_STATE:
        return "another call must come first";
    case TRIBO_ERR_UNSUPPORTED:
        return "not available here";
    case TRIBO_ERR_MEMORY:
        return "out of memory";
    case TRIBO_ERR_NOT_SYMMETRIC:
        return "a matrix is not symmetric";
    case TRIBO_ERR_INDEFINITE:
        return "a matrix is not positive (semi)definite";
    case TRIBO_ERR_DUPLICATE:
        return "an entry is given twice";
    case TRIBO_ERR_INCONSISTENT:
        return "no balancing force exists in the partition coupling; the least-squares one was returned";
    case TRIBO_ERR_NO_CONVERGENCE:
        return "a solver did not converge";
    case TRIBO_ERR_STOPPED:
        return "the observer ended the run";
    case TRIBO_ERR_STEP:
        return "the step size became too small";
    case TRIBO_ERR_CALLBACK:
        return "a function of the caller's failed";
    case TRIBO_ERR_CHATTER:
        return "too many events in too short a time: \"central/fixed\" and \"moreau/fixed\" step over them";
    default:
        return "not a tribo status";
    }
}
