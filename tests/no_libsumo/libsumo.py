"""Stands in libsumo's place in the children of a test that is not marked ``sumo``."""

raise ImportError("this test starts SUMO in a child: mark it `sumo`")
