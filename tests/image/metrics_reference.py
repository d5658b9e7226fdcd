# Prints the reference values of metrics_test.cpp, computed independently with numpy, scipy and
# scikit-image (python3-skimage), with full two-dimensional kernels. Run by hand, never by the build.
import numpy as np
from scipy import ndimage
from skimage.metrics import structural_similarity as ssim
W,H=64,48
def image(shift,gain):
    a=np.zeros((H,W,3))
    for y in range(H):
        for x in range(W):
            X=x+shift
            a[y,x,0]=0.5+0.3*np.sin(0.35*X)*np.cos(0.22*y)+0.15*(1 if (X//8+y//6)%2 else -1)
            a[y,x,1]=0.4+0.3*np.cos(0.21*X+0.4*y)
            a[y,x,2]=0.6*gain+0.3*np.sin(0.8*X-0.1*y)
    return np.floor(np.clip(a,0,1)*255+0.5)/255
A=image(0,1.0);B=image(1,0.9)
A=A.astype(np.float32).astype(np.float64);B=B.astype(np.float32).astype(np.float64)
print("mae",np.abs(A-B).mean(),"mse",((A-B)**2).mean(),"max",np.abs(A-B).max())
g=dict(gaussian_weights=True,sigma=1.5,use_sample_covariance=False,data_range=1.0)
print("uniform7",np.mean([ssim(A[...,c],B[...,c],data_range=1.0) for c in range(3)]))
print("valid(gauss)",np.mean([ssim(A[...,c],B[...,c],**g) for c in range(3)]))
# zero pad: full then direct
def zp(a,b):
    k=np.exp(-np.arange(-5,6)**2/(2*1.5**2));k/=k.sum();K=np.outer(k,k)
    f=lambda q: ndimage.correlate(q,K,mode='constant')
    ma,mb=f(a),f(b);va=f(a*a)-ma*ma;vb=f(b*b)-mb*mb;c=f(a*b)-ma*mb
    return (((2*ma*mb+1e-4)*(2*c+9e-4))/((ma*ma+mb*mb+1e-4)*(va+vb+9e-4))).mean()
print("zero",np.mean([zp(A[...,c],B[...,c]) for c in range(3)]))
# FLIP by full 2-D kernels
# XYZ from linear sRGB, from the chromaticities of the primaries and of D65.
P=np.array([[.64/.33,.30/.60,.15/.06],[1,1,1],[.03/.33,.10/.60,.79/.06]])
M=P*np.linalg.solve(P,np.array([.3127/.3290,1,(1-.3127-.3290)/.3290]))
white=M@np.ones(3)
lin=lambda s: np.where(s>0.04045,((s+0.055)/1.055)**2.4,s/12.92)
def flip(A,B,ppd):
    def ycc(s):
        r=(lin(s)@M.T)/white
        return np.stack([116*r[...,1]-16,500*(r[...,0]-r[...,1]),200*(r[...,1]-r[...,2])],-1)
    rad=int(np.ceil(3*np.sqrt(0.04/(2*np.pi**2))*ppd))
    d=np.arange(-rad,rad+1)/ppd; z=d[:,None]**2+d[None]**2
    def ker(a1,b1,a2,b2):
        k=a1*np.sqrt(np.pi/b1)*np.exp(-np.pi**2*z/b1)+a2*np.sqrt(np.pi/b2)*np.exp(-np.pi**2*z/b2)
        return k/k.sum()
    K=[ker(1,.0047,0,1e-5),ker(1,.0053,0,1e-5),ker(34.1,.04,13.5,.025)]
    def lab(rgb):
        r=(rgb@M.T)/white; dl=6/29
        f=np.where(r>dl**3,np.cbrt(r),r/(3*dl*dl)+4/29)
        L=116*f[...,1]-16
        return np.stack([L,.01*L*500*(f[...,0]-f[...,1]),.01*L*200*(f[...,1]-f[...,2])],-1)
    def pre(s):
        c=ycc(s); c=np.stack([ndimage.correlate(c[...,i],K[i],mode='nearest') for i in range(3)],-1)
        y=(c[...,0]+16)/116; xyz=np.stack([y+c[...,1]/500,y,y-c[...,2]/200],-1)*white
        return lab(np.clip(xyz@np.linalg.inv(M).T,0,1))
    hy=lambda p,q: np.abs(p[...,0]-q[...,0])+np.linalg.norm(p[...,1:]-q[...,1:],axis=-1)
    cm=hy(lab(np.array([0.,1,0])),lab(np.array([0.,0,1])))**.7
    e=hy(pre(A),pre(B))**.7
    e=np.where(e<.4*cm,.95/(.4*cm)*e,.95+(e-.4*cm)/(cm-.4*cm)*.05)
    sd=.5*.082*ppd; r=int(np.ceil(3*sd)); x,y=np.meshgrid(np.arange(-r,r+1),np.arange(-r,r+1)); g=np.exp(-(x*x+y*y)/(2*sd*sd))
    def norm(k):
        k=k.copy();p=k[k>0].sum();n=-k[k<0].sum(); return np.where(k>0,k/p,k/n)
    E=norm(-x*g);P=norm((x*x/(sd*sd)-1)*g)
    def feat(s,k):
        l=(ycc(s)[...,0]+16)/116
        return np.hypot(ndimage.correlate(l,k,mode='nearest'),ndimage.correlate(l,k.T,mode='nearest'))
    ef=np.maximum(np.abs(feat(A,E)-feat(B,E)),np.abs(feat(A,P)-feat(B,P)))
    ef=(ef/np.sqrt(2))**.5
    return e**(1-ef), cm
m,cm=flip(A,B,67.0)
print("flip",m.mean(),"cmax",cm, m[0,0],m[10,20],m[47,63],m.max())
m2,_=flip(A,B,30.0); print("flip30",m2.mean())
c=lambda r,g,b: np.tile(np.array([r,g,b],float),(40,40,1))
print("black-white",flip(c(0,0,0),c(1,1,1),67.)[0].mean(),"green-blue",flip(c(0,1,0),c(0,0,1),67.)[0].mean(), "grey", flip(c(.5,.5,.5),c(.6,.5,.5),67.)[0].mean())
