"""Problems with published values, the results of both models, and effects that beam theory neglects."""
