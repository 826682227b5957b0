"""Structs of raw memory as compiled code sees them: references with named fields, lists and arrays of them.

``@struct`` turns a class of annotations into a layout in words of 8 bytes; a function annotated with the class gets a
reference to such a struct. References are plain pointers: nothing is counted, nothing is checked. ``if job.worker:``
asks whether there is one, ``job.worker = NOTHING`` takes it away, ``is`` compares.
"""

from __future__ import annotations

import operator
import re
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from llvmlite import ir
from numba.core import types
from numba.core.imputils import lower_cast, lower_getattr_generic, lower_setattr_generic
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, infer_getattr, infer_global, signature
from numba.extending import lower_builtin, models, register_model

from opsim.engine.fast_engine.machine.code_cache import STAMP
from opsim.engine.fast_engine.machine.compiling import intrinsic

WORD = 8
LIST_WORDS = 4
"""Of a list inside a struct: where its items are, the number of the first, how many, and for how many there is room."""
_SCALARS = {"int": "int", "bool": "int", "float": "float", "Call": "int"}
"""NOTE: a Call is the line of a step in the table."""
_GENERIC = re.compile(r"(List|Array)\[(.+)\]$")
_NAMED = re.compile(r"Annotated\[Any, ['\"](\w+)['\"]\]$")
"""Of a struct that is defined elsewhere: ``Annotated[Any, "Name"]``."""


@dataclass(frozen=True)
class Field:
    """kind : ``int``, ``float``, ``ref``, ``list`` or ``array``; of : what a reference leads to, what items are

    at : bytes from the beginning of the struct
    """

    kind: str
    of: str
    at: int

    @property
    def words(self) -> int:
        return LIST_WORDS if self.kind == "list" else 1


@dataclass(frozen=True)
class Layout:
    """name : of the struct; fields by name, in their order; size : bytes."""

    name: str
    fields: dict[str, Field]
    size: int


LAYOUTS: dict[str, Layout] = {}


def layout_of(cls: Any) -> Layout:
    """The layout of a class of annotations, known by its name from now on. Raises ValueError for a name taken."""
    fields: dict[str, Field] = {}
    at = 0
    for name, said in cls.__annotations__.items():
        field = _field(said if isinstance(said, str) else said.__name__, at)
        fields[name] = field
        at += field.words * WORD
    made = Layout(cls.__name__, fields, at)
    if LAYOUTS.get(made.name, made) != made:
        raise ValueError(f"two structs are called {made.name}")
    LAYOUTS[made.name] = made
    return made


def _field(said: str, at: int) -> Field:
    named = _NAMED.match(said)
    if named is not None:
        return Field("ref", named[1], at)
    generic = _GENERIC.match(said)
    if generic is not None:
        return Field(generic[1].lower(), _SCALARS.get(generic[2], generic[2]), at)
    if said in _SCALARS:
        return Field(_SCALARS[said], "", at)
    return Field("ref", said, at)


T = TypeVar("T")
NOTHING: Any = None
"""Where a reference leads that leads nowhere."""
I8, I64 = ir.IntType(8), ir.IntType(64)
POINTER = I8.as_pointer()
SCALARS = {"int": types.int64, "float": types.float64}


class Array(Generic[T]):
    """Words side by side, for type checkers: ``array[i]``. There is no length."""

    def __getitem__(self, item: int) -> T:
        raise NotImplementedError

    def __setitem__(self, item: int, value: T) -> None:
        raise NotImplementedError


class List(Array[T]):
    """A list inside a struct, for type checkers: ``len(list)``, ``list[i]``, and the functions of ``lists``."""

    def __len__(self) -> int:
        raise NotImplementedError


class Pointer(types.Type):
    """To a struct, to a list inside one, or to the words of an array. ``of``: of which struct, or of what items."""

    def __init__(self, of: str, kind: str = "ref"):
        self.of, self.kind = of, kind
        super().__init__(f"{kind}:{of}:{STAMP}")

    @property
    def key(self) -> str:
        return self.name

    def can_convert_from(self, _typingctx: Any, other: Any) -> Any:
        """A reference to anything, and none, fit everywhere."""
        from numba.core.typeconv import Conversion

        if other == types.none or (isinstance(other, Pointer) and "Any" in (self.of, other.of)):
            return Conversion.safe
        return None


def Ref(struct: str) -> Pointer:
    """The type of references to structs of a name."""
    return Pointer(struct)


def struct(cls: type[T]) -> type[T]:
    """A class of annotations: int, float, bool, another struct, List[...] or Array[...] of those."""
    layout_of(cls)
    return cls


def type_of(said: str) -> Any:
    """The compiled type that an annotation stands for."""
    if said in SCALARS:
        return SCALARS[said]
    return types.int64 if said in ("bool", "Call") else Ref(said)


def _field_type(pointer: Pointer, name: str) -> Any:
    field = LAYOUTS[pointer.of].fields.get(name) if pointer.kind == "ref" else None
    if field is None:
        return None
    if field.kind in SCALARS:
        return SCALARS[field.kind]
    return Pointer(field.of, field.kind) if field.kind != "ref" else Ref(field.of)


def at_byte(builder: Any, pointer: Any, byte: int, llvm_type: Any) -> Any:
    """A pointer to something so many bytes behind another."""
    moved = builder.gep(pointer, [ir.Constant(I64, byte)], inbounds=True) if byte else pointer
    return builder.bitcast(moved, llvm_type.as_pointer())


@register_model(Pointer)
class PointerModel(models.PrimitiveModel):
    def __init__(self, dmm: Any, fe_type: Any):
        super().__init__(dmm, fe_type, POINTER)


@infer_getattr
class Fields(AttributeTemplate):
    key = Pointer

    def generic_resolve(self, pointer: Any, name: Any) -> Any:  # type: ignore[override]
        return _field_type(pointer, name)


@lower_getattr_generic(Pointer)
def _get_field(context: Any, builder: Any, pointer: Pointer, value: Any, name: str) -> Any:
    field = LAYOUTS[pointer.of].fields[name]
    if field.kind == "list":
        return at_byte(builder, value, field.at, I8)
    return builder.load(at_byte(builder, value, field.at, context.get_value_type(_field_type(pointer, name))))


@lower_setattr_generic(Pointer)
def _set_field(context: Any, builder: Any, sig: Any, args: Any, name: str) -> None:
    pointer, given = sig.args
    wanted = _field_type(pointer, name)
    value = context.cast(builder, args[1], given, wanted)
    at = LAYOUTS[pointer.of].fields[name].at
    builder.store(value, at_byte(builder, args[0], at, context.get_value_type(wanted)))


@lower_cast(types.none, Pointer)
def _no_reference(_context: Any, _builder: Any, _given: Any, _wanted: Any, _value: Any) -> Any:
    return ir.Constant(POINTER, None)


@lower_cast(Pointer, Pointer)
def _other_reference(_context: Any, _builder: Any, _given: Any, _wanted: Any, value: Any) -> Any:
    return value


@infer_global(bool)
class Truth(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        return signature(types.boolean, args[0]) if len(args) == 1 and isinstance(args[0], Pointer) else None


def _truth(sign: str) -> Any:
    """Of a list, whether anything is in it; of anything else, whether it is there."""

    def truth(_context: Any, builder: Any, sig: Any, args: Any) -> Any:
        if sig.args[0].kind != "list":
            return builder.icmp_unsigned(sign, args[0], ir.Constant(POINTER, None))
        words = builder.bitcast(args[0], I64.as_pointer())
        n_items = builder.load(builder.gep(words, [ir.Constant(I64, 2)], inbounds=True))
        return builder.icmp_unsigned(sign, n_items, ir.Constant(I64, 0))

    return truth


lower_builtin(bool, Pointer)(_truth("!="))
lower_builtin(operator.not_, Pointer)(_truth("=="))


@infer_global(operator.not_)
class NoTruth(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        return signature(types.boolean, args[0]) if len(args) == 1 and isinstance(args[0], Pointer) else None


class _Same(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        both = len(args) == 2 and all(isinstance(one, Pointer) for one in args)
        return signature(types.boolean, *args) if both else None


def _compare(sign: str) -> Any:
    return lambda _context, builder, _sig, args: builder.icmp_unsigned(sign, *args)


for _operator, _sign in ((operator.is_, "=="), (operator.is_not, "!="), (operator.eq, "=="), (operator.ne, "!=")):
    infer_global(_operator)(type("Same", (_Same,), {}))
    lower_builtin(_operator, Pointer, Pointer)(_compare(_sign))


@intrinsic
def word(_typingctx: Any, pointer: Any, index: Any) -> Any:
    """Word ``index`` of a struct or a list, as a whole number."""

    def codegen(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        words = builder.bitcast(args[0], I64.as_pointer())
        return builder.load(builder.gep(words, [args[1]], inbounds=True))

    return types.int64(pointer, types.int64), codegen


@intrinsic
def set_word(_typingctx: Any, pointer: Any, index: Any, value: Any) -> Any:
    def codegen(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
        words = builder.bitcast(args[0], I64.as_pointer())
        builder.store(args[2], builder.gep(words, [args[1]], inbounds=True))

    return types.void(pointer, types.int64, types.int64), codegen


@intrinsic
def address_of(_typingctx: Any, pointer: Any) -> Any:
    """Where a reference leads, as a number; 0: nowhere."""
    return types.int64(pointer), lambda _c, builder, _s, args: builder.ptrtoint(args[0], I64)


def _item_type(pointer: Any) -> Any:
    """The type of what a list or an array holds; None for anything else."""
    if not isinstance(pointer, Pointer) or pointer.kind == "ref":
        return None
    return SCALARS.get(pointer.of) or Ref(pointer.of)


def _place(context: Any, builder: Any, pointer: Any, given: Any, index: Any) -> Any:
    """A pointer to item ``index`` of a list or an array."""
    at = given
    if pointer.kind == "list":
        words = builder.bitcast(given, I64.as_pointer())
        first = builder.load(builder.gep(words, [ir.Constant(I64, 1)], inbounds=True))
        data = builder.load(builder.bitcast(given, POINTER.as_pointer()))
        at = builder.bitcast(builder.gep(builder.bitcast(data, I64.as_pointer()), [first]), POINTER)
    items_at = builder.bitcast(at, context.get_value_type(_item_type(pointer)).as_pointer())
    return builder.gep(items_at, [index], inbounds=True)


@infer_global(operator.getitem)
class ItemOf(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        item = _item_type(args[0]) if len(args) == 2 and isinstance(args[1], types.Integer) else None
        return None if item is None else signature(item, args[0], types.int64)


@infer_global(operator.setitem)
class ItemPut(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        item = _item_type(args[0]) if len(args) == 3 and isinstance(args[1], types.Integer) else None
        return None if item is None else signature(types.none, args[0], types.int64, item)


@infer_global(len)
class ItemsIn(AbstractTemplate):
    def generic(self, args: Any, kws: Any) -> Any:
        is_list = len(args) == 1 and isinstance(args[0], Pointer) and args[0].kind == "list"
        return signature(types.int64, args[0]) if is_list else None


@lower_builtin(operator.getitem, Pointer, types.int64)
def _get_item(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    return builder.load(_place(context, builder, sig.args[0], args[0], args[1]))


@lower_builtin(operator.setitem, Pointer, types.int64, types.Any)
def _set_item(context: Any, builder: Any, sig: Any, args: Any) -> Any:
    value = context.cast(builder, args[2], sig.args[2], _item_type(sig.args[0]))
    builder.store(value, _place(context, builder, sig.args[0], args[0], args[1]))
    return context.get_dummy_value()


@lower_builtin(len, Pointer)
def _n_items(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
    words = builder.bitcast(args[0], I64.as_pointer())
    return builder.load(builder.gep(words, [ir.Constant(I64, 2)], inbounds=True))


def cast(struct: Any) -> Any:
    """A compiled function that takes a reference to anything, or an address, for one to a struct."""
    wanted = Ref(struct.__name__)

    @intrinsic
    def taken_for(_typingctx: Any, pointer: Any) -> Any:
        def codegen(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
            return builder.inttoptr(args[0], POINTER) if isinstance(pointer, types.Integer) else args[0]

        return wanted(pointer), codegen

    return taken_for


@intrinsic
def _as_any(_typingctx: Any, address: Any) -> Any:
    return Ref("Any")(types.int64), lambda _c, builder, _s, args: builder.inttoptr(args[0], POINTER)


def size_of(struct: Any) -> int:
    """Bytes of a struct, a multiple of 16."""
    return -(-LAYOUTS[struct.__name__].size // (2 * WORD)) * 2 * WORD


def array_at(of: str) -> Any:
    """A compiled function that takes an address for that of an array: of ``int``, ``float`` or structs of a name."""
    array = Pointer(of, "array")

    @intrinsic
    def taken_for(_typingctx: Any, address: Any) -> Any:
        return array(types.int64), lambda _c, builder, _s, args: builder.inttoptr(args[0], POINTER)

    return taken_for


def _set(bits: int) -> Any:
    @intrinsic
    def set_number(_typingctx: Any, address: Any, item: Any, value: Any) -> Any:
        def codegen(_context: Any, builder: Any, _sig: Any, args: Any) -> Any:
            narrow = ir.IntType(bits)
            items = builder.inttoptr(args[0], narrow.as_pointer())
            builder.store(builder.trunc(args[2], narrow), builder.gep(items, [args[1]], inbounds=True))

        return types.void(types.int64, types.int64, types.int64), codegen

    return set_number


set_byte, set_half = _set(8), _set(32)
"""``set_half(address, item, value)``: item of an array of int32 at an address; of int8."""
